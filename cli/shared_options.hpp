#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace prowl::cli {

// Options that several verbs have, in the same words.
void add_plan_directory(CLI::App& verb, std::string& directory);  ///< the folder that prowl plan wrote; required
void add_package_dirs(CLI::App& verb, std::vector<std::string>& folders);  ///< --package-dir, for package_search()
void add_json(CLI::App& verb, bool& json);                                 ///< --json

}  // namespace prowl::cli
