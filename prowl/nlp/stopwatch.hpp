#pragma once

#include <chrono>
#include <ctime>

namespace prowl {

inline double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// CPU time of all threads of the process [s].
inline double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Adds its lifetime to a sum [s].
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), began_(wall_seconds()) {}
  ~Stopwatch() { sum_ += wall_seconds() - began_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_;
  double began_;
};

}  // namespace prowl
