#pragma once

#include <vector>

#include "prowl/io/plan_directory.hpp"
#include "prowl/plan.hpp"

namespace prowl::cli {

/// Writes one line an iteration to stderr, under a heading that comes again with each mesh, and every 20 lines in a
/// terminal. Plain text, so that it reads the same when piped. Keeps them for the record of the plan.
class ProgressPrinter {
 public:
  ProgressPrinter();

  /// Sets on_iteration and on_level; this has to outlive the solve.
  void watch(PlanOptions& options);

  /// Of all meshes so far.
  const std::vector<MeshIteration>& iterations() const { return iterations_; }

 private:
  void begin_level(int intervals);
  void print(const SolveProgress& progress);

  bool in_terminal_;
  int line_ = 0;
  int level_ = -1;
  std::vector<MeshIteration> iterations_;
};

}  // namespace prowl::cli
