#pragma once

#include "prowl/session/plan_task.hpp"

namespace prowl::cli {

/// Writes one line an iteration to stderr, under a heading that comes again with each mesh, and every 20 lines in a
/// terminal. Plain text, so that it reads the same when piped.
class ProgressPrinter {
 public:
  ProgressPrinter();

  /// Sets on_mesh and on_iteration; this has to outlive the solve.
  void watch(PlanRequest& request);

 private:
  void begin_mesh(int intervals);
  void print(const SolveProgress& progress);

  bool in_terminal_;
  int line_ = 0;
};

}  // namespace prowl::cli
