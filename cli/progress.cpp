#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "output.hpp"

namespace prowl::cli {

std::function<void(const SolveProgress&)> progress_printer() {
  constexpr int kLinesAHeading = 20;
  return [line = 0, in_terminal = ::isatty(STDERR_FILENO) == 1](const SolveProgress& progress) mutable {
    if (line == 0 || (in_terminal && line % kLinesAHeading == 0)) {
      print_message(fmt::format("{:>9}  {:>13}  {:>10}  {:>10}  {:>9}\n", "iteration", "objective", "constraint",
                                "dual", "elapsed"));
    }
    print_message(fmt::format("{:>9}  {:>13.6e}  {:>10.2e}  {:>10.2e}  {:>7.2f} s\n", progress.iteration, progress.cost,
                              progress.constraint_violation, progress.dual_violation, progress.elapsed_seconds));
    ++line;
  };
}

}  // namespace prowl::cli
