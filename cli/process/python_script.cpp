#include "cli/process/python_script.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "cli/process/process.hpp"
#include "cli/process/program_files.hpp"
#include "prowl/error.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kNoLibrary = 3;

}  // namespace

std::string default_python() {
  const char* const python = std::getenv("PROWL_PYTHON");
  return python ? python : PROWL_PYTHON;
}

std::vector<std::string> script_command(const std::string& python, const std::string& script) {
  std::error_code ignored;
  const fs::path path = share_folder() / script;
  if (!fs::exists(path, ignored))
    throw FileError(fmt::format("{}: missing; it belongs to this program", path.string()));
  return {python, "-B", path.string()};
}

void run_script(const Python& python, const std::string& script, const std::vector<std::string>& arguments,
                const std::function<void(const std::string&)>& on_line) {
  std::vector<std::string> command = script_command(python.program, script);
  command.insert(command.end(), arguments.begin(), arguments.end());
  const int status = run_program(command, on_line);
  if (status == kNoLibrary) {
    throw InputError(fmt::format("{}: need a Python with {} (scripts/setup makes one in .venv): --python PATH",
                                 python.program, python.libraries));
  }
  if (status != 0) throw Error(fmt::format("{} failed with status {}", command[2], status));
}

}  // namespace prowl::cli
