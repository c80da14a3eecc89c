#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace prowl::cli {

/// A program that talks with us over its stdin and stdout, in bytes; what it says on stderr goes where our messages go.
class SocketProcess {
 public:
  /// Without a shell; the first argument is the program, looked for in PATH if it has no path. Throws InputError if it
  /// cannot be started.
  explicit SocketProcess(const std::vector<std::string>& arguments);
  /// Ends it, if it has not by itself.
  ~SocketProcess();
  SocketProcess(const SocketProcess&) = delete;
  SocketProcess& operator=(const SocketProcess&) = delete;

  /// False if it does not listen any more.
  bool send(const void* data, std::size_t size);
  enum class Got { all, stopped, end };
  /// Waits for so many bytes. `stop` is asked ten times a second whether to go on waiting.
  Got receive(void* data, std::size_t size, const std::function<bool()>& stop);
  /// Waits for its end: its exit status, 128 + N if signal N ended it.
  int wait();

 private:
  int socket_ = -1;
  pid_t child_ = 0;
};

}  // namespace prowl::cli
