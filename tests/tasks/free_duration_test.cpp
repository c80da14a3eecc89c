// Durations as decision variables: HyQ stands up by 6 cm, with a price on time and one on acceleration.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "prowl/plan.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

constexpr double kLongest = 1e9;  // [s]

/// Of a motion of two phases, each with the duration that the text says.
Plan stand_up(const std::string& duration, const std::string& steps = "equal") {
  const test::TempFolder folder;
  folder.write("hyq.toml", test::kHyqFile);
  const std::string phase =
      fmt::format("[[phase]]\ncontacts = \"all\"\nduration_s = {}\nintervals = 6\nsteps = \"{}\"\n", duration, steps);
  folder.write("up.toml", "robot = \"hyq.toml\"\n" + phase + phase + R"([[goal]]
phase = "phase 2"
base_displacement_m = [0, 0, 0.06]
base_rpy_rad = [0, 0, 0]
base_linear_velocity_mps = [0, 0, 0]
base_angular_velocity_radps = [0, 0, 0]
[cost]
time = 0.2
base_linear_acceleration = 1.0
base_angular_acceleration = 1.0
joint_acceleration = 0.01
torque = 1e-5
)");
  const Task task = read_task_file(folder.path() / "up.toml", test::test_search(), {});
  Plan plan = make_plan({task.problem, task.mesh}, IpoptSolver(), {.solver = task.solver});
  EXPECT_EQ(plan.result.status, SolveStatus::converged) << duration;
  return plan;
}

double duration_of_phase(const Plan& plan, int phase) {
  double first = 0.0, last = 0.0;
  for (const TrajectoryPoint& node : plan.trajectory.nodes) {
    if (node.phase < phase) first = node.time;
    if (node.phase <= phase) last = node.time;
  }
  return last - first;
}

TEST(FreeDuration, BeatsFixedOnes) {
  const Plan free = stand_up("[0.1, 4.0]");
  for (const int phase : {0, 1}) {
    EXPECT_GT(duration_of_phase(free, phase), 0.1 + 1e-3) << "a bound, no optimum";
    EXPECT_LT(duration_of_phase(free, phase), 4.0 - 1e-3);
  }
  for (const char* fixed : {"0.25", "0.5", "1.0"}) {
    EXPECT_GT(stand_up(fixed).result.cost, free.result.cost * (1.0 + 1e-4)) << fixed << " s";
  }
  // Fixed at what the optimiser chose, it is the same motion.
  const Plan same = stand_up(fmt::format("{:.17g}", free.trajectory.duration() / 2.0));
  EXPECT_NEAR(same.result.cost, free.result.cost, 1e-3 * free.result.cost);
}

TEST(FreeDuration, StopsAtItsBounds) {
  const double best = stand_up("[0.1, 4.0]").trajectory.duration() / 2.0;
  const double shorter = 0.7 * best, longer = 1.4 * best;
  const Plan at_most = stand_up(fmt::format("[{:.6f}, {:.6f}]", 0.5 * shorter, shorter));
  const Plan at_least = stand_up(fmt::format("[{:.6f}, {:.6f}]", longer, 2.0 * longer));
  for (const int phase : {0, 1}) {
    EXPECT_NEAR(duration_of_phase(at_most, phase), shorter, 1e-5);
    EXPECT_NEAR(duration_of_phase(at_least, phase), longer, 1e-5);
  }
}

/// Equal steps are one choice among the free ones.
TEST(FreeDuration, OfEachStepCostsNoMoreThanEqualSteps) {
  const Plan equal = stand_up("[0.3, 0.9]"), free = stand_up("[0.3, 0.9]", "free");
  EXPECT_LT(free.result.cost, equal.result.cost);
  EXPECT_GT(free.result.cost, 0.5 * equal.result.cost) << "another motion, so that this test compares nothing";
  double shortest = kLongest, longest = 0.0, total = 0.0;
  for (int phase = 0; phase < 12; ++phase) {
    const double step = duration_of_phase(free, phase);
    EXPECT_GE(step, 0.05 - 1e-6);
    EXPECT_LE(step, 0.15 + 1e-6);
    shortest = std::min(shortest, step);
    longest = std::max(longest, step);
    total += step;
  }
  EXPECT_NEAR(total, free.trajectory.duration(), 1e-12);
  EXPECT_GT(longest, shortest + 1e-3) << "all equal: nothing was chosen";
}

}  // namespace
}  // namespace prowl
