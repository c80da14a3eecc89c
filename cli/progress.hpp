#pragma once

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl::cli {

/// Writes one line an iteration to stderr, under a heading that comes again with each mesh, and every 20 lines in a
/// terminal. Plain text, so that it reads the same when piped.
class ProgressPrinter {
 public:
  ProgressPrinter();
  void begin_level(int intervals);
  void print(const SolveProgress& progress);

 private:
  bool in_terminal_;
  int line_ = 0;
};

}  // namespace prowl::cli
