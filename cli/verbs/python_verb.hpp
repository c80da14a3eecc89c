#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace prowl::cli {

/// That of the environment variable PROWL_PYTHON, which the command of the wheel sets, or else that of the build.
std::string default_python();

/// The Python package of this program: in a build, installed, or in a wheel. It need not be there.
std::filesystem::path python_package();

/// What a verb has that the Python package does (python/prowl/_verb.py).
struct PythonVerb {
  std::string directory, out, python = default_python();
  std::vector<std::string> package_dirs;
  bool json = false;
};

/// --python; `libraries`: that the verb needs.
void add_python(CLI::App& verb, std::string& python, const std::string& libraries);

/// Passes on all options that the verb was given, shows messages and progress, prints the result and returns the exit
/// status. Throws InputError, FileError or NumericalError as the package raises them, and Error if it fails otherwise.
int run_python_verb(const CLI::App& verb, const PythonVerb& arguments);

}  // namespace prowl::cli
