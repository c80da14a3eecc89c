// A problem solved from the plan of a neighbouring one: the goal elsewhere, or the horizon one interval later.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/mesh/receding_horizon.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

Task read(const std::string& name, int intervals) {
  return read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/" + name + ".toml", test::test_search(),
                        {.intervals = intervals});
}

Plan solve(const DiscreteProblem& discrete, const Task& task, PlanOptions options = {}) {
  options.solver = task.solver;
  return make_plan(discrete, RiccatiSolver(), options);
}

Plan solve(const Task& task, PlanOptions options = {}) {
  return solve({task.problem, task.mesh}, task, std::move(options));
}

double duration(const MotionProblem& problem) {
  double sum = 0.0;
  for (const Phase& phase : problem.phases) sum += phase.duration.max;
  return sum;
}

/// Solves it three times more, each a step later, and returns the iterations of each.
std::vector<int> run_three_steps(const Task& task, bool with_multipliers) {
  DiscreteProblem discrete(task.problem, task.mesh);
  Plan plan = solve(discrete, task);
  EXPECT_EQ(plan.result.status, SolveStatus::converged);
  std::vector<int> iterations;
  for (int i = 0; i < 3; ++i) {
    ShiftedHorizon next = shift_horizon(discrete, plan.trajectory, plan.result.stage_multipliers);
    const MotionProblem& problem = next.problem.problem;
    EXPECT_NEAR(duration(problem), duration(discrete.problem), 1e-9);
    const TrajectoryPoint second = plan.trajectory.nodes[1];
    EXPECT_EQ(problem.start_configuration(), second.q);
    EXPECT_EQ(problem.start().velocity_lower, second.v);
    discrete = next.problem;
    plan = solve(
        discrete, task,
        {.warm_start = next.warm_start,
         .warm_start_multipliers = with_multipliers ? next.warm_start_multipliers : std::vector<StageMultipliers>{}});
    EXPECT_EQ(plan.result.status, SolveStatus::converged) << plan.result.message;
    EXPECT_TRUE(plan.certificate.passed) << "step " << i;
    EXPECT_LT((plan.trajectory.nodes.front().q - second.q).norm(), 1e-9)
        << "the motion does not go on from where it was";
    iterations.push_back(plan.result.iterations);
  }
  return iterations;
}

DiscreteProblem with_goal_moved(const Task& task, int axis, double by) {
  MotionProblem problem = task.problem;
  problem.boundary_constraints.back().q_ref(axis) += by;
  return {std::move(problem), task.mesh};
}

/// Each direction of the goal, also those in which a filter would halve Newton's first step.
TEST(SolveAgain, TakesFewIterationsWithTheGoalElsewhere) {
  const Task task = read("balance", 160);
  const Plan plan = solve(task);
  ASSERT_EQ(plan.result.status, SolveStatus::converged);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double by : {-0.02, 0.02}) {
      const Plan again =
          solve(with_goal_moved(task, axis, by), task,
                {.warm_start = plan.trajectory, .warm_start_multipliers = plan.result.stage_multipliers});
      EXPECT_EQ(again.result.status, SolveStatus::converged) << again.result.message;
      EXPECT_LE(again.result.iterations, 5) << "axis " << axis << " by " << by;
    }
  }
}

/// So far that Newton's first steps lead nowhere.
TEST(SolveAgain, FindsAGoalThatIsFarFromTheOldOne) {
  const Task task = read("crouch", 40);
  const Plan plan = solve(task);
  const DiscreteProblem moved = with_goal_moved(task, 0, -0.2);
  const Plan again =
      solve(moved, task, {.warm_start = plan.trajectory, .warm_start_multipliers = plan.result.stage_multipliers});
  const Plan alone = solve(moved, task);
  EXPECT_EQ(alone.result.status, SolveStatus::converged) << alone.result.message;
  EXPECT_EQ(again.result.status, SolveStatus::converged) << again.result.message;
}

TEST(SolveAgain, FindsWhatTheTaskAloneFinds) {
  Task task = read("balance", 60);
  task.solver.tolerance = 1e-9;  // the barrier's part of the cost goes with it
  const Plan plan = solve(task);
  const DiscreteProblem moved = with_goal_moved(task, 0, 0.02);
  const Plan alone = solve(moved, task);
  const Plan again =
      solve(moved, task, {.warm_start = plan.trajectory, .warm_start_multipliers = plan.result.stage_multipliers});
  ASSERT_EQ(again.result.status, SolveStatus::converged) << again.result.message;
  EXPECT_NEAR(again.result.cost, alone.result.cost, 1e-7 * alone.result.cost);
  for (std::size_t k = 0; k < alone.trajectory.nodes.size(); ++k) {
    EXPECT_LT((again.trajectory.nodes[k].v - alone.trajectory.nodes[k].v).norm(), 1e-5) << "node " << k;
  }
}

TEST(ShiftHorizon, GoesOnInFewIterations) {
  const std::vector<int> iterations = run_three_steps(read("crouch", 80), true);
  EXPECT_LE(*std::ranges::max_element(iterations), 4);
}

TEST(ShiftHorizon, MultipliersHelp) {
  const Task task = read("balance", 160);
  const std::vector<int> with = run_three_steps(task, true), without = run_three_steps(task, false);
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_LT(with[i], without[i]) << "step " << i;
}

TEST(ShiftHorizon, KeepsGoalsAtTheirTimes) {
  const Task task = read("balance", 60);
  MotionProblem problem = task.problem;
  const Mesh& mesh = task.mesh;
  const Plan plan = solve(task);
  BoundaryConstraint goal = problem.boundary_constraints.back();
  const int last = static_cast<int>(problem.phases.size()) - 1, end = mesh.phases.back().intervals();
  ASSERT_GT(last, 0);
  problem.boundary_constraints.resize(1);
  for (const auto& [phase, node] : {std::pair{0, 1}, {0, 3}, {1, 2}, {last, end - 1}, {last, end}}) {
    goal.at = {phase, 1.0 * node / mesh.phases[phase].intervals()};
    problem.boundary_constraints.push_back(goal);
  }
  const DiscreteProblem before(problem, mesh), after = shift_horizon(before, plan.trajectory, {}).problem;
  std::vector<std::pair<int, int>> nodes;
  for (const int k : after.boundary_nodes) nodes.emplace_back(after.nodes[k].phase, after.nodes[k].node);
  EXPECT_EQ(nodes, (std::vector<std::pair<int, int>>{{0, 0}, {0, 2}, {1, 2}, {last, end - 1}, {last, end + 1}}));
  EXPECT_EQ(after.mesh.phases.front().intervals(), mesh.phases.front().intervals() - 1);
  EXPECT_EQ(after.mesh.phases.back().intervals(), end + 1);
  for (int p = 0; p <= last; ++p) {  // all intervals as long as they were
    const auto interval = [p](const DiscreteProblem& of) {
      return of.problem.phases[p].duration.max / of.mesh.phases[p].intervals();
    };
    EXPECT_NEAR(interval(after), interval(before), 1e-12) << "phase " << p;
  }
}

/// Steps of different length, in one phase and in several: all that stay are as long as before, and what comes is as
/// long as the last.
TEST(ShiftHorizon, KeepsStepsOfDifferentLength) {
  for (const char* name : {"crouch", "balance"}) {
    const Task task = read(name, 30);
    Mesh mesh;
    for (const PhaseMesh& phase : task.mesh.phases) {
      std::vector<double> steps;
      for (int i = 0; i < phase.intervals(); ++i) steps.push_back(1.0 + i % 3);
      mesh.phases.emplace_back(steps);
    }
    const DiscreteProblem before(task.problem, mesh);
    const Plan plan = solve(before, task);
    ASSERT_EQ(plan.result.status, SolveStatus::converged) << plan.result.message;
    const ShiftedHorizon shifted = shift_horizon(before, plan.trajectory, {});
    const DiscreteProblem& after = shifted.problem;
    ASSERT_EQ(after.num_nodes(), before.num_nodes());
    const auto step = [](const DiscreteProblem& of, int k) { return of.nodes[k].h_out; };
    for (int k = 0; k + 2 < before.num_nodes(); ++k)
      EXPECT_NEAR(step(after, k), step(before, k + 1), 1e-9) << name << ", node " << k;
    const bool is_single = task.problem.phases.size() == 1;
    EXPECT_NEAR(step(after, after.num_nodes() - 2), step(before, is_single ? 0 : before.num_nodes() - 2), 1e-9) << name;
    for (std::size_t k = 0; k < after.nodes.size(); ++k) {
      EXPECT_NEAR(shifted.warm_start.nodes[k].time, after.nodes[k].time, 1e-9) << name << ", node " << k;
    }
    EXPECT_NO_THROW(validate(after.problem));
  }
}

TEST(ShiftHorizon, RefusesWhatIsOver) {
  const Task task = read("crouch", 40);
  const Plan plan = solve(task);
  Trajectory cut = plan.trajectory;
  cut.nodes.pop_back();
  EXPECT_THROW(shift_horizon({task.problem, task.mesh}, cut, {}), InputError);
  MotionProblem problem = task.problem;
  std::erase_if(problem.boundary_constraints, [](const BoundaryConstraint& constraint) {
    return constraint.at.fraction > 0.0 && constraint.at.fraction < 1.0;
  });
  const DiscreteProblem one_interval(problem, {{PhaseMesh(1)}});
  const Trajectory two_nodes{{plan.trajectory.nodes.front(), plan.trajectory.nodes.back()}};
  EXPECT_THROW(shift_horizon(one_interval, two_nodes, {}), InputError);
}

}  // namespace
}  // namespace prowl
