#pragma once

#include "prowl/session/plan_task.hpp"

namespace prowl::cli {

/// Writes one line per iteration to stderr, as plain text. The heading is repeated for each mesh,
/// and every 20 lines in a terminal.
class ProgressPrinter {
 public:
  ProgressPrinter();

  /// Sets on_mesh and on_iteration; this must outlive the solve.
  void watch(PlanRequest& request);

 private:
  void begin_mesh(int intervals);
  void print(const SolveProgress& progress);

  bool in_terminal_;
  int line_ = 0;
};

}  // namespace prowl::cli
