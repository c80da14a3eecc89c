#include "cli/screen/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "cli/screen/output.hpp"

namespace prowl::cli {

ProgressPrinter::ProgressPrinter() : in_terminal_(::isatty(STDERR_FILENO) == 1) {}

void ProgressPrinter::watch(PlanRequest& request) {
  request.on_mesh = [this](int intervals) { begin_mesh(intervals); };
  request.on_iteration = [this](const SolveProgress& iteration) { print(iteration); };
}

void ProgressPrinter::begin_mesh(int intervals) {
  print_progress(fmt::format("mesh of {} interval{}\n", intervals, intervals == 1 ? "" : "s"));
  line_ = 0;
}

void ProgressPrinter::print(const SolveProgress& progress) {
  constexpr int kLinesAHeading = 20;
  if (line_ == 0 || (in_terminal_ && line_ % kLinesAHeading == 0)) {
    print_progress(fmt::format("{:>9}  {:>13}  {:>10}  {:>10}  {:>9}\n", "iteration", "objective", "constraint", "dual",
                               "elapsed"));
  }
  print_progress(fmt::format("{:>9}  {:>13.6e}  {:>10.2e}  {:>10.2e}  {:>7.2f} s\n", progress.iteration, progress.cost,
                             progress.constraint_violation, progress.dual_violation, progress.elapsed_seconds));
  ++line_;
}

}  // namespace prowl::cli
