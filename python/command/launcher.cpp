// The command of the wheel: runs the program inside the package, with the Python of the same environment for the verbs
// that need it. A script of Python's would start it 40 ms later.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace fs = std::filesystem;

namespace {

/// lib/python3.11/site-packages/prowl/bin/prowl below the environment; Debian's own Python has dist-packages. Empty if
/// there is none.
fs::path find_program(const fs::path& environment) {
  std::error_code error;
  for (const char* lib : {"lib", "lib64"}) {
    for (const fs::directory_entry& python : fs::directory_iterator(environment / lib, error)) {
      for (const char* packages : {"site-packages", "dist-packages"}) {
        const fs::path program = python.path() / packages / "prowl/bin/prowl";
        if (fs::exists(program, error)) return program;
      }
    }
  }
  return {};
}

}  // namespace

int main(int, char** argv) {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path program = find_program(folder.parent_path());
  if (program.empty()) {
    std::fprintf(stderr, "prowl: no package prowl beside %s: pip install prowl\n", folder.c_str());
    return 4;
  }
  const fs::path python = folder / "python3";
  if (fs::exists(python, error)) ::setenv("PROWL_PYTHON", python.c_str(), 0);
  ::execv(program.c_str(), argv);
  std::perror(program.c_str());
  return 4;
}
