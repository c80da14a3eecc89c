// Plans that an interrupt or the time limit stops before their last mesh.
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "prowl/mesh/mesh_levels.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

class StoppedPlan : public testing::Test {
 protected:
  StoppedPlan() {
    options_.solver = task_.solver;
    options_.on_level = [this](int intervals) { meshes_.push_back(intervals); };
  }
  Plan plan() const { return make_plan({task_.problem, task_.mesh}, RiccatiSolver(), options_); }

  Task task_ = read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/balance.toml", test::test_search(),
                              {.intervals = 120});
  int coarsest_ = mesh_levels(task_.problem, task_.mesh).front().num_intervals();
  PlanOptions options_;
  std::vector<int> meshes_;
};

TEST_F(StoppedPlan, StaysOnTheMeshWhereItWasInterrupted) {
  std::atomic<bool> stop = false;
  double violation = 0.0;
  options_.solver.interrupt = &stop;
  options_.solver.on_iteration = [&](const SolveProgress& now) {
    violation = now.constraint_violation;
    stop = now.iteration == 4;
  };
  const Plan stopped = plan();
  EXPECT_EQ(stopped.result.status, SolveStatus::interrupted);
  EXPECT_EQ(meshes_, std::vector{coarsest_});
  EXPECT_LE(stopped.result.constraint_violation, violation) << "further off than the last iterate";

  EXPECT_EQ(stopped.mesh.num_intervals(), coarsest_);
  EXPECT_EQ(stopped.trajectory.nodes.size(), static_cast<std::size_t>(coarsest_) + stopped.mesh.phases.size());
  EXPECT_EQ(static_cast<int>(stopped.certificate.interval_errors.size()), coarsest_) << "judged on another mesh";

  stop = false;
  meshes_.clear();
  options_.solver.on_iteration = {};
  options_.warm_start = stopped.trajectory;
  options_.resume = true;
  const Plan resumed = plan();
  EXPECT_EQ(resumed.result.status, SolveStatus::converged) << resumed.result.message;
  EXPECT_EQ(meshes_.front(), coarsest_);
  EXPECT_EQ(resumed.mesh.num_intervals(), 120);
}

TEST_F(StoppedPlan, StaysOnTheMeshWhereTheTimeRanOut) {
  options_.solver.max_seconds = 1e-9;
  const Plan stopped = plan();
  EXPECT_EQ(stopped.result.status, SolveStatus::time_limit);
  EXPECT_EQ(meshes_, std::vector{coarsest_});
  EXPECT_EQ(stopped.mesh.num_intervals(), coarsest_);
}

/// Iterations are counted on each mesh anew.
TEST_F(StoppedPlan, GoesOnToTheNextMeshAfterItsIterations) {
  options_.solver.max_iterations = 2;
  const Plan stopped = plan();
  EXPECT_EQ(stopped.result.status, SolveStatus::iteration_limit);
  EXPECT_EQ(meshes_.back(), 120);
  EXPECT_EQ(stopped.mesh.num_intervals(), 120);
}

}  // namespace
}  // namespace prowl
