#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace prowl::cli {

/// Python of the environment variable PROWL_PYTHON, set by the command of the wheel, or of the
/// build.
std::string default_python();

/// Folder of the Python package: in a build, installed, or in a wheel. It may be missing.
std::filesystem::path python_package();

/// Arguments of a verb in the Python package (python/prowl/_verb.py).
struct PythonVerb {
  std::string directory, out, python = default_python();
  std::vector<std::string> package_dirs;
  bool json = false, allow_libraries = false;
};

/// --python; `libraries`: requirements of the verb, in words.
void add_python(CLI::App& verb, std::string& python, const std::string& libraries);

/// Passes on all given options, shows messages and progress, prints the result and returns the exit
/// status. Throws InputError, FileError or NumericalError if the package raises them, else Error.
int run_python_verb(const CLI::App& verb, const PythonVerb& arguments);

}  // namespace prowl::cli
