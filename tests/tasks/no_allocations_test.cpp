// A solve takes its memory at first: iterations after the second take none.
#include <gtest/gtest.h>

#include "prowl/guess/initial_guess.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/task_file/task_file.hpp"
#include "prowl/transcription/transcription.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

#ifdef PROWL_COUNTS_ALLOCATIONS
TEST(RiccatiSolver, AllocatesNothingAfterTheSecondIteration) {
  const std::string file = std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/stand.toml";
  const Task task = read_task_file(file, test::test_search(), {.intervals = 24});
  const DiscreteProblem discrete(task.problem, task.mesh);
  const Trajectory guess = initial_guess(discrete);
  Transcription nlp(discrete, guess);

  std::vector<long> counts(static_cast<std::size_t>(task.solver.max_iterations) + 1, 0);
  long ended = 0;
  SolverOptions options = task.solver;
  options.on_iteration = [&](const SolveProgress& progress) {
    counts[progress.iteration] = test::allocations - ended;
    ended = test::allocations;
  };
  const SolveResult result = RiccatiSolver().solve(nlp, nlp.pack(guess), options);
  ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
  ASSERT_GE(result.iterations, 5) << "too few to tell";
  EXPECT_GT(counts[0], 0) << "allocations in Prowl's libraries go unseen";
  for (int i = 3; i < result.iterations; ++i) EXPECT_EQ(counts[i], 0) << "iteration " << i;
}
#endif

}  // namespace
}  // namespace prowl
