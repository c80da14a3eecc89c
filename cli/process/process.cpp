#include "cli/process/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "prowl/error.hpp"

namespace prowl::cli {

int run_program(const std::vector<std::string>& arguments, const std::function<void(const std::string&)>& on_line) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments)
    argv.push_back(const_cast<char*>(argument.c_str()));  // as POSIX requires
  argv.push_back(nullptr);

  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(fmt::format("{}: no pipe: {}", arguments[0], std::strerror(errno)));
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  ::close(ends[1]);
  const std::unique_ptr<FILE, int (*)(FILE*)> printed(::fdopen(ends[0], "r"), ::fclose);
  if (error != 0) throw InputError(fmt::format("{}: cannot be run: {}", arguments[0], std::strerror(error)));

  char* text = nullptr;
  std::size_t size = 0;
  for (ssize_t length = 0; printed && (length = ::getline(&text, &size, printed.get())) > 0;) {
    on_line(std::string(text, static_cast<std::size_t>(length - (text[length - 1] == '\n' ? 1 : 0))));
  }
  std::free(text);

  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw Error(fmt::format("{}: {}", arguments[0], std::strerror(errno)));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace prowl::cli
