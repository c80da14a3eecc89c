#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <optional>
#include <utility>

namespace prowl::python {

/// Checks for Ctrl-C, from code without the GIL. Throws nanobind::python_error with the exception
/// of the signal handler. Only Python's main thread handles signals.
inline void check_signals() {
  const nanobind::gil_scoped_acquire in_python;
  if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
}

/// The same at every `every`-th call.
class SignalCheck {
 public:
  explicit SignalCheck(int every) : every_(every) {}
  void operator()() {
    if (++calls_ % every_ == 0) check_signals();
  }

 private:
  int every_, calls_ = 0;
};

/// Connects C++ without the GIL to Python. Ctrl-C and exceptions of a callback set stop(), and are
/// kept here until C++ has returned: they must not pass through foreign code.
class Stop {
 public:
  /// Calls `callback` with the GIL, unless already stopped.
  template <class Callback>
  void ask(const Callback& callback) {
    if (stop_) return;
    const nanobind::gil_scoped_acquire in_python;
    try {
      if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
      callback();
    } catch (nanobind::python_error& error) {
      keep(std::move(error));
    }
  }
  void keep(nanobind::python_error error) {
    error_.emplace(std::move(error));
    stop_ = true;
  }

  const std::atomic<bool>& stop() const { return stop_; }
  std::optional<nanobind::python_error>& error() { return error_; }

 private:
  std::optional<nanobind::python_error> error_;
  std::atomic<bool> stop_ = false;
};

}  // namespace prowl::python
