// A problem solved from the plan of a neighbouring one: the goal elsewhere, or the horizon one interval later.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../io/test_files.hpp"
#include "prowl/error.hpp"
#include "prowl/io/task_file.hpp"
#include "prowl/mesh/receding_horizon.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/riccati_solver.hpp"
#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/remesh.hpp"

namespace prowl {
namespace {

Task read(const std::string& name, int intervals) {
  return read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/" + name + ".toml", test::test_search(),
                        {.intervals = intervals});
}

Plan solve(const MotionProblem& problem, const Task& task, PlanOptions options = {}) {
  options.solver = task.solver;
  return make_plan(problem, RiccatiSolver(), options);
}

double duration(const MotionProblem& problem) {
  double sum = 0.0;
  for (const Phase& phase : problem.phases) sum += phase.duration.max;
  return sum;
}

/// Solves it three times more, each a step later, and returns the iterations of each.
std::vector<int> run_three_steps(const Task& task, bool with_multipliers) {
  MotionProblem problem = task.problem;
  Plan plan = solve(problem, task);
  EXPECT_EQ(plan.result.status, SolveStatus::converged);
  std::vector<int> iterations;
  for (int i = 0; i < 3; ++i) {
    ShiftedHorizon next = shift_horizon(problem, plan.trajectory, plan.result.stage_multipliers);
    EXPECT_NEAR(duration(next.problem), duration(problem), 1e-9);
    const TrajectoryPoint second = plan.trajectory.nodes[1];
    EXPECT_EQ(next.problem.start_configuration(), second.q);
    EXPECT_EQ(next.problem.start().velocity_lower, second.v);
    problem = next.problem;
    plan = solve(problem, task,
                 {.start_from = next.start_from,
                  .start_multipliers = with_multipliers ? next.start_multipliers : std::vector<StageMultipliers>{}});
    EXPECT_EQ(plan.result.status, SolveStatus::converged) << plan.result.message;
    EXPECT_TRUE(plan.certificate.passed) << "step " << i;
    EXPECT_LT((plan.trajectory.nodes.front().q - second.q).norm(), 1e-9)
        << "the motion does not go on from where it was";
    iterations.push_back(plan.result.iterations);
  }
  return iterations;
}

MotionProblem with_goal_moved(const Task& task, int axis, double by) {
  MotionProblem problem = task.problem;
  problem.boundary_conditions.back().q_ref(axis) += by;
  return problem;
}

/// Each direction of the goal, also those in which a filter would halve Newton's first step.
TEST(SolveAgain, TakesFewIterationsWithTheGoalElsewhere) {
  const Task task = read("balance", 120);
  const Plan plan = solve(task.problem, task);
  ASSERT_EQ(plan.result.status, SolveStatus::converged);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double by : {-0.02, 0.02}) {
      const Plan again = solve(with_goal_moved(task, axis, by), task,
                               {.start_from = plan.trajectory, .start_multipliers = plan.result.stage_multipliers});
      EXPECT_EQ(again.result.status, SolveStatus::converged) << again.result.message;
      EXPECT_LE(again.result.iterations, 5) << "axis " << axis << " by " << by;
    }
  }
}

/// So far that Newton's first steps lead nowhere.
TEST(SolveAgain, FindsAGoalThatIsFarFromTheOldOne) {
  const Task task = read("crouch", 40);
  const Plan plan = solve(task.problem, task);
  const MotionProblem problem = with_goal_moved(task, 0, -0.2);
  const Plan again =
      solve(problem, task, {.start_from = plan.trajectory, .start_multipliers = plan.result.stage_multipliers});
  const Plan alone = solve(problem, task);
  EXPECT_EQ(alone.result.status, SolveStatus::converged) << alone.result.message;
  EXPECT_EQ(again.result.status, SolveStatus::converged) << again.result.message;
}

TEST(SolveAgain, FindsWhatTheTaskAloneFinds) {
  Task task = read("balance", 60);
  task.solver.tolerance = 1e-9;  // the barrier's part of the cost goes with it
  const Plan plan = solve(task.problem, task);
  const MotionProblem problem = with_goal_moved(task, 0, 0.02);
  const Plan alone = solve(problem, task);
  const Plan again =
      solve(problem, task, {.start_from = plan.trajectory, .start_multipliers = plan.result.stage_multipliers});
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
  const Task task = read("balance", 120);
  const std::vector<int> with = run_three_steps(task, true), without = run_three_steps(task, false);
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_LT(with[i], without[i]) << "step " << i;
}

TEST(ShiftHorizon, KeepsGoalsAtTheirTimes) {
  Task task = read("balance", 60);
  MotionProblem& problem = task.problem;
  const Plan plan = solve(problem, task);
  BoundaryCondition goal = problem.boundary_conditions.back();
  const int last = static_cast<int>(problem.phases.size()) - 1, end = problem.phases.back().intervals;
  ASSERT_GT(last, 0);
  problem.boundary_conditions.resize(1);
  for (const NodeRef at : {NodeRef{0, 1}, NodeRef{0, 3}, NodeRef{1, 2}, NodeRef{last, end - 1}, NodeRef{last, end}}) {
    goal.at = at;
    problem.boundary_conditions.push_back(goal);
  }
  const MotionProblem shifted = shift_horizon(problem, plan.trajectory, {}).problem;
  std::vector<NodeRef> places;
  for (const BoundaryCondition& condition : shifted.boundary_conditions) places.push_back(condition.at);
  EXPECT_EQ(places, (std::vector<NodeRef>{{0, 0}, {0, 2}, {1, 2}, {last, end - 1}, {last, end + 1}}));
  EXPECT_EQ(shifted.phases.front().intervals, problem.phases.front().intervals - 1);
  EXPECT_EQ(shifted.phases.back().intervals, end + 1);
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {  // all intervals as long as they were
    const Phase &before = problem.phases[p], &after = shifted.phases[p];
    EXPECT_NEAR(after.duration.max / after.intervals, before.duration.max / before.intervals, 1e-12) << "phase " << p;
  }
}

/// Steps of different length, in one phase and in several: all that stay are as long as before, and what comes is as
/// long as the last.
TEST(ShiftHorizon, KeepsStepsOfDifferentLength) {
  for (const char* name : {"crouch", "balance"}) {
    Task task = read(name, 30);
    std::vector<Steps> steps;
    for (const Phase& phase : task.problem.phases) {
      Steps& of_phase = steps.emplace_back();
      for (int i = 0; i < phase.intervals; ++i) of_phase.push_back(1.0 + i % 3);
    }
    const MotionProblem problem = on_mesh(task.problem, steps);
    const Plan plan = solve(problem, task);
    ASSERT_EQ(plan.result.status, SolveStatus::converged) << plan.result.message;
    const ShiftedHorizon shifted = shift_horizon(problem, plan.trajectory, {});
    const Mesh before = make_mesh(problem), after = make_mesh(shifted.problem);
    ASSERT_EQ(after.size(), before.size());
    const auto step = [](const Mesh& mesh, int k) { return mesh.nodes[k].h_out; };
    for (int k = 0; k + 2 < before.size(); ++k)
      EXPECT_NEAR(step(after, k), step(before, k + 1), 1e-9) << name << ", node " << k;
    const bool is_single = problem.phases.size() == 1;
    EXPECT_NEAR(step(after, after.size() - 2), step(before, is_single ? 0 : before.size() - 2), 1e-9) << name;
    for (std::size_t k = 0; k < after.nodes.size(); ++k) {
      EXPECT_NEAR(shifted.start_from.nodes[k].time, after.nodes[k].time, 1e-9) << name << ", node " << k;
    }
    EXPECT_NO_THROW(validate(shifted.problem));
  }
}

TEST(ShiftHorizon, RefusesWhatIsOver) {
  Task task = read("crouch", 40);
  const Plan plan = solve(task.problem, task);
  Trajectory cut = plan.trajectory;
  cut.nodes.pop_back();
  EXPECT_THROW(shift_horizon(task.problem, cut, {}), InputError);
  task.problem.phases.front().intervals = 1;
  EXPECT_THROW(shift_horizon(task.problem, plan.trajectory, {}), InputError);
}

}  // namespace
}  // namespace prowl
