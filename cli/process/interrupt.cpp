#include "cli/process/interrupt.hpp"

#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "cli/process/exit_status.hpp"

namespace prowl::cli {
namespace {

std::atomic<bool> interrupted_once = false, has_hung_up = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch nothing else");

extern "C" void on_interrupt(int signal) {
  if (signal == SIGHUP) has_hung_up = true;
  if (interrupted_once.exchange(true)) {
    if (signal == SIGHUP) return;  // shell and kernel may both send it
    ::_exit(kInterrupted);
  }
  const int before = errno;  // of the interrupted code
  constexpr char kNotice[] = "\nstopping after the current step; press Ctrl-C again to end at once\n";
  [[maybe_unused]] const auto ignored = ::write(STDERR_FILENO, kNotice, sizeof(kNotice) - 1);
  errno = before;
}

}  // namespace

bool is_terminal_gone() { return has_hung_up; }

const std::atomic<bool>& catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    // Respects nohup, and `prowl ... &` in scripts: Ctrl-C is for the foreground.
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);  // a closed progress pipe must not stop the solve
  return interrupted_once;
}

}  // namespace prowl::cli
