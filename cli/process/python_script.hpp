#pragma once

#include <functional>
#include <string>
#include <vector>

namespace prowl::cli {

/// That of the environment variable PROWL_PYTHON, which the command of the wheel sets, or else that of the build.
std::string default_python();

struct Python {
  std::string program;
  std::string libraries;  ///< that the script needs, for messages
};

/// That runs share/prowl/`script`, in a build as well as installed. Throws FileError if the script is missing.
std::vector<std::string> script_command(const std::string& python, const std::string& script);

/// Runs share/prowl/`script`, in a build as well as installed, and waits for it; a script that finds no library ends
/// with status 3. Throws InputError if Python or a library is missing, FileError if the script is, Error for any other
/// failure. `on_line` gets every line that it prints.
void run_script(const Python& python, const std::string& script, const std::vector<std::string>& arguments,
                const std::function<void(const std::string& line)>& on_line);

}  // namespace prowl::cli
