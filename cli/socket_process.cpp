#include "socket_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "prowl/error.hpp"

namespace prowl::cli {

SocketProcess::SocketProcess(const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments)
    argv.push_back(const_cast<char*>(argument.c_str()));  // as POSIX wants it
  argv.push_back(nullptr);

  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw Error(fmt::format("{}: no socket: {}", arguments[0], std::strerror(errno)));
  }
  socket_ = ends[0];
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[1], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
  const int error = ::posix_spawnp(&child_, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  ::close(ends[1]);
  if (error == 0) return;
  ::close(socket_);
  throw InputError(fmt::format("{}: cannot be run: {}", arguments[0], std::strerror(error)));
}

SocketProcess::~SocketProcess() {
  ::close(socket_);
  if (child_ == 0) return;
  ::kill(child_, SIGKILL);
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool SocketProcess::send(const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::send(socket_, next, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return false;
    next += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

SocketProcess::Got SocketProcess::receive(void* data, std::size_t size, const std::function<bool()>& stop) {
  constexpr int kTenthOfASecond = 100;  // [ms]
  char* next = static_cast<char*>(data);
  while (size > 0) {
    pollfd readable = {.fd = socket_, .events = POLLIN, .revents = 0};
    const int ready = ::poll(&readable, 1, kTenthOfASecond);
    if (stop()) return Got::stopped;
    if (ready <= 0) continue;
    const ssize_t received = ::recv(socket_, next, size, 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) return Got::end;
    next += received;
    size -= static_cast<std::size_t>(received);
  }
  return Got::all;
}

int SocketProcess::wait() {
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0) {
    if (errno != EINTR) throw Error(std::strerror(errno));
  }
  child_ = 0;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace prowl::cli
