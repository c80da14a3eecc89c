// Meshes that follow the measured errors, on shipped tasks.
#include "prowl/refine.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "prowl/mesh/mesh_levels.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/failing_solver.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

Task read(const std::string& name, std::optional<int> intervals = std::nullopt) {
  return read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/" + name + ".toml", test::test_search(),
                        {.intervals = intervals});
}

const RefineOptions kUntilItPasses{.tolerance = mesh_tolerance(CertificateGrade::draft), .mesh_is_open = true};

RefinedPlan refine(const Task& task, const NlpSolver& solver = RiccatiSolver(), PlanOptions options = {},
                   RefineOptions refine = {.tolerance = mesh_tolerance(CertificateGrade::draft)}) {
  options.solver = task.solver;
  return make_refined_plan({task.problem, task.mesh}, solver, options, refine);
}

void expect_within(const MeshTolerance& errors, const MeshTolerance& tolerance) {
  EXPECT_LE(errors.local, tolerance.local);
  EXPECT_LE(errors.second, tolerance.second);
  EXPECT_LE(errors.reintegration, tolerance.reintegration);
}

/// The trapezoid meets grade draft with so many equal steps.
TEST(Refine, MeetsTheToleranceWithFewerIntervalsThanEqualSteps) {
  for (const auto& [name, intervals] : {std::pair{"crouch", 80}, std::pair{"step", 250}}) {
    const Task task = read(name, intervals);
    const RefinedPlan refined = refine(task);
    ASSERT_EQ(refined.plan.result.status, SolveStatus::converged) << name;
    EXPECT_TRUE(refined.meets_tolerance) << name;
    EXPECT_TRUE(refined.plan.certificate.passed) << name;
    EXPECT_TRUE(refined.plan.hints.empty()) << name;
    expect_within(mesh_errors(refined.plan.certificate), mesh_tolerance(CertificateGrade::draft));
    const int count = refined.plan.mesh.num_intervals();
    EXPECT_LT(count, 0.8 * task.mesh.num_intervals()) << name;

    Task equal = read(name, count);  // as many, equal
    const Plan plan = make_plan({equal.problem, equal.mesh}, RiccatiSolver(), {.solver = equal.solver});
    EXPECT_GT(mesh_errors(plan.certificate).local, mesh_tolerance(CertificateGrade::draft).local) << name;
  }
}

TEST(Refine, FindsAMeshWhereTheTaskHasNone) {
  for (const auto& [name, equal] : {std::pair{"crouch", 80}, std::pair{"step", 250}, std::pair{"jump", 288}}) {
    const Task task = read(name);
    EXPECT_FALSE(task.has_intervals);
    const RefinedPlan found = refine(task, RiccatiSolver(), {}, kUntilItPasses);
    EXPECT_TRUE(found.meets_tolerance) << name;
    EXPECT_TRUE(is_good(found.plan)) << name;
    EXPECT_LT(found.plan.mesh.num_intervals(), 0.6 * equal) << name << ": fewer than equal steps of the trapezoid";
    EXPECT_LE(found.plan.levels.size(), 5u) << name;
  }
}

TEST(Refine, BeginsOnAFinerMeshWhereTheFirstHasNoSolution) {
  const Task task = read("crouch");
  const test::FailingSolver fails_once(0, SolveStatus::infeasible, 1);
  const RefinedPlan found = refine(task, fails_once, {}, kUntilItPasses);
  EXPECT_TRUE(is_good(found.plan));
  ASSERT_GE(found.plan.levels.size(), 2u);
  EXPECT_EQ(found.plan.levels[1].intervals, 2 * task.mesh.num_intervals());

  const RefinedPlan none = refine(task, test::FailingSolver(0, SolveStatus::infeasible), {}, kUntilItPasses);
  EXPECT_EQ(none.plan.result.status, SolveStatus::infeasible);
  EXPECT_EQ(none.plan.mesh.num_intervals(), 4 * task.mesh.num_intervals());
}

TEST(Refine, SolvesFromTheTaskAgainWhereAFinerMeshFails) {
  const test::FailingSolver fails_second(1, SolveStatus::solver_failed, 1);
  const RefinedPlan found = refine(read("crouch"), fails_second, {}, kUntilItPasses);
  EXPECT_TRUE(is_good(found.plan));
  ASSERT_GE(found.plan.levels.size(), 3u);
  EXPECT_EQ(found.plan.levels[2].intervals, found.plan.levels[1].intervals);
  EXPECT_NE(fails_second.guesses[2], fails_second.guesses[1]);
}

TEST(Refine, GoalsKeepTheirTimes) {
  const Task task = read("rear", 344);  // a goal in the middle of a phase
  const Mesh mesh = refine(task).plan.mesh;
  const std::vector<int> nodes = find_boundary_nodes(task.problem, mesh);
  int inside = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto [phase, fraction] = task.problem.boundary_constraints[i].at;
    EXPECT_NEAR(mesh.phases[phase].node_time(nodes[i] - mesh.first_node(phase), 1.0), fraction, 1e-9);
    inside += fraction > 0.0 && fraction < 1.0;
  }
  EXPECT_EQ(inside, 1);
}

TEST(Refine, TakesEverySolverOfPlan) {
  const Task task = read("step", 250);
  for (const char* name : {"riccati", "fatrop", "ipopt"}) {
    const RefinedPlan refined = refine(task, *make_solver(name));
    EXPECT_TRUE(refined.meets_tolerance) << name;
    EXPECT_TRUE(refined.plan.certificate.passed) << name;
    EXPECT_LT(refined.plan.mesh.num_intervals(), 125) << name;
  }
}

TEST(Refine, BooksAreOfAllMeshes) {
  const Task task = read("step", 250);
  std::vector<RefineRound> rounds;
  RefineOptions options{.tolerance = mesh_tolerance(CertificateGrade::draft)};
  options.on_round = [&](const RefineRound& round) { rounds.push_back(round); };
  const RefinedPlan refined = refine(task, RiccatiSolver(), {}, options);
  ASSERT_GE(rounds.size(), 3u);
  ASSERT_EQ(refined.plan.levels.size(), rounds.size());
  int iterations = 0;
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    EXPECT_EQ(refined.plan.levels[i].intervals, rounds[i].intervals);
    EXPECT_EQ(refined.plan.levels[i].iterations, rounds[i].iterations);
    iterations += rounds[i].iterations;
  }
  EXPECT_EQ(refined.plan.result.iterations, iterations);
  EXPECT_LE(rounds.front().intervals, 48) << "from a coarse mesh";
  EXPECT_GT(rounds.front().error, 10.0 * rounds.back().error);
  EXPECT_GT(rounds.front().too_coarse, 0);
  EXPECT_EQ(rounds.back().too_coarse, 0);
}

/// Out of reach in two meshes: the better one, and word of it.
TEST(Refine, TellsWhatItDidNotReach) {
  const Task task = read("step", 250);
  const RefinedPlan refined =
      refine(task, RiccatiSolver(), {}, {.tolerance = mesh_tolerance(CertificateGrade::certified), .max_rounds = 2});
  EXPECT_FALSE(refined.meets_tolerance);
  EXPECT_EQ(refined.plan.result.status, SolveStatus::converged);
  EXPECT_EQ(refined.plan.mesh.num_intervals(), refined.plan.levels.back().intervals);
  ASSERT_EQ(refined.plan.hints.size(), 1u);
  EXPECT_THAT(refined.plan.hints[0], HasSubstr("mesh refinement stopped, after 2 solves: "));
}

/// What there is stays, and an interrupt is known as one.
TEST(Refine, KeepsTheLastMotionThatConverged) {
  const Task task = read("step", 250);
  for (const SolveStatus status : {SolveStatus::iteration_limit, SolveStatus::interrupted}) {
    std::vector<int> intervals;
    RefineOptions options{.tolerance = mesh_tolerance(CertificateGrade::draft)};
    options.on_round = [&](const RefineRound& round) { intervals.push_back(round.intervals); };
    const RefinedPlan refined = refine(task, test::FailingSolver(2, status), {}, options);
    ASSERT_EQ(intervals.size(), 2u);
    EXPECT_FALSE(refined.meets_tolerance);
    EXPECT_EQ(refined.plan.result.status, SolveStatus::converged);
    EXPECT_EQ(refined.interrupted, status == SolveStatus::interrupted);
    EXPECT_EQ(refined.plan.mesh.num_intervals(), intervals[1]);
    EXPECT_EQ(refined.plan.certificate.interval_errors.size(), static_cast<std::size_t>(intervals[1]));
    EXPECT_EQ(refined.plan.levels.size(), status == SolveStatus::interrupted ? 3u : 4u) << "once more from the task";
    ASSERT_EQ(refined.plan.hints.size(), 1u);
    EXPECT_THAT(refined.plan.hints[0], HasSubstr(to_string(status)));
  }
}

/// Not of the coarsest, if that fails: the next finer one is tried, from the task.
TEST(Refine, BeginsOnTheFirstMeshThatConverges) {
  const Task task = read("step", 250);
  std::vector<int> intervals;
  RefineOptions options{.tolerance = mesh_tolerance(CertificateGrade::draft)};
  options.on_round = [&](const RefineRound& round) { intervals.push_back(round.intervals); };
  const RefinedPlan begun = refine(task, test::FailingSolver(0, SolveStatus::solver_failed, 1), {}, options);
  EXPECT_TRUE(begun.meets_tolerance);
  ASSERT_FALSE(intervals.empty());
  EXPECT_EQ(intervals.front(), mesh_levels(task.problem, task.mesh).at(1).num_intervals());
  EXPECT_EQ(begun.plan.levels.at(0).status, SolveStatus::solver_failed);

  const RefinedPlan failed = refine(task, test::FailingSolver(0, SolveStatus::iteration_limit));
  EXPECT_EQ(failed.plan.result.status, SolveStatus::iteration_limit);
  EXPECT_EQ(failed.plan.levels.size(), mesh_levels(task.problem, task.mesh).size());
  EXPECT_EQ(failed.plan.mesh.num_intervals(), task.mesh.num_intervals());
}

/// Also where the sum of errors over a second is what holds the mesh.
TEST(Refine, MeshesOnlyGetFiner) {
  for (const double tolerance : {0.02, 1e-3, 5e-6}) {
    std::vector<int> intervals;
    RefineOptions options{.tolerance = mesh_tolerance(tolerance)};
    options.on_round = [&](const RefineRound& round) { intervals.push_back(round.intervals); };
    const RefinedPlan refined = refine(read("crouch", 80), RiccatiSolver(), {}, options);
    EXPECT_TRUE(refined.meets_tolerance) << tolerance;
    EXPECT_LT(intervals.size(), 8u) << tolerance;
    EXPECT_TRUE(std::ranges::is_sorted(intervals)) << tolerance;
  }
}

TEST(Refine, NeedsFarFewerIntervalsThanTheTrapezoid) {
  const RefinedPlan draft = refine(read("crouch"), RiccatiSolver(), {}, kUntilItPasses);
  EXPECT_EQ(draft.plan.trajectory.interpolation, Interpolation::hermite);
  const RefinedPlan certified =
      refine(read("crouch"), RiccatiSolver(), {},
             {.tolerance = mesh_tolerance(CertificateGrade::certified), .mesh_is_open = true});
  EXPECT_EQ(certified.plan.certificate.grade, CertificateGrade::certified);
  EXPECT_LT(draft.plan.mesh.num_intervals(), 80 / 1.9) << "the trapezoid needs 80";
  EXPECT_LT(certified.plan.mesh.num_intervals(), 344 / 3) << "the trapezoid needs 344";
}

TEST(Refine, BeginsNoMeshWhenTheTimeIsUp) {
  Task task = read("step", 250);
  task.solver.max_seconds = 1e-3;
  const RefinedPlan refined = refine(task);
  EXPECT_EQ(refined.plan.result.status, SolveStatus::time_limit);
  EXPECT_EQ(refined.plan.levels.size(), 1u);
  EXPECT_EQ(refined.plan.mesh.num_intervals(), mesh_levels(task.problem, task.mesh).front().num_intervals());
}

/// An uneven mesh is as good as any: no drift, the same motion.
TEST(Refine, AMeshOfRandomStepsGivesTheSameMotion) {
  const Task task = read("crouch", 160);
  std::mt19937 rng(29);
  std::uniform_real_distribution<double> step(1.0, 4.0);
  std::vector<double> steps(160);
  for (double& h : steps) h = step(rng);
  // The goal is in the middle of the phase, and of the steps.
  const auto middle = steps.begin() + 80;
  const double first = std::accumulate(steps.begin(), middle, 0.0), second = std::accumulate(middle, steps.end(), 0.0);
  std::for_each(middle, steps.end(), [&](double& h) { h *= first / second; });
  const Plan expected = make_plan({task.problem, task.mesh}, RiccatiSolver(), {.solver = task.solver});
  const Plan plan = make_plan({task.problem, {{PhaseMesh(steps)}}}, RiccatiSolver(), {.solver = task.solver});
  ASSERT_EQ(plan.result.status, SolveStatus::converged);
  EXPECT_TRUE(plan.certificate.passed);
  EXPECT_NEAR(plan.result.cost, expected.result.cost, 2e-3 * expected.result.cost);
  for (double t = 0.0; t <= 2.0; t += 0.05) {
    const TrajectoryPoint a = sample(plan.trajectory, t), b = sample(expected.trajectory, t);
    EXPECT_LT((a.q - b.q).cwiseAbs().maxCoeff(), 1e-3) << "t = " << t;
  }
}

}  // namespace
}  // namespace prowl
