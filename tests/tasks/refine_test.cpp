// Meshes that follow the measured errors, on shipped tasks.
#include "prowl/refine.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <regex>
#include <string>
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

/// A shipped task without its intervals.
Task read_without_intervals(const std::string& name) {
  SourceText file = read_text_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/" + name + ".toml");
  file.text = std::regex_replace(file.text, std::regex("\nintervals[^\n]*"), "");
  return read_task_text(file, test::test_search(), {});
}

const RefineOptions kUntilItPasses{.tolerance = mesh_tolerance(CertificateGrade::draft), .ends_when_met = true};

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

/// What the shipped mesh, of equal steps in each phase, is fine enough for; its task says that less of it fail.
TEST(Refine, MeetsTheToleranceWithFewerIntervalsThanEqualSteps) {
  for (const char* name : {"crouch", "step", "rear"}) {
    const Task task = read(name);
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
  for (const char* name : {"crouch", "step", "jump"}) {
    const Task task = read_without_intervals(name);
    EXPECT_FALSE(task.has_intervals);
    const RefinedPlan found = refine(task, RiccatiSolver(), {}, kUntilItPasses);
    EXPECT_TRUE(found.meets_tolerance) << name;
    EXPECT_TRUE(is_good(found.plan)) << name;
    EXPECT_LT(found.plan.mesh.num_intervals(), read(name).mesh.num_intervals()) << name << ": fewer than by hand";
    EXPECT_LE(found.plan.levels.size(), 5u) << name;
  }
}

TEST(Refine, BeginsOnAFinerMeshWhereTheFirstHasNoSolution) {
  const Task task = read_without_intervals("crouch");
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
  const RefinedPlan found = refine(read_without_intervals("crouch"), fails_second, {}, kUntilItPasses);
  EXPECT_TRUE(is_good(found.plan));
  ASSERT_GE(found.plan.levels.size(), 3u);
  EXPECT_EQ(found.plan.levels[2].intervals, found.plan.levels[1].intervals);
  EXPECT_NE(fails_second.guesses[2], fails_second.guesses[1]);
}

TEST(Refine, GoalsKeepTheirTimes) {
  const Task task = read("rear");  // a goal in the middle of a phase
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

TEST(Refine, MergesWhatIsTooFine) {
  const Task task = read("crouch", 320);
  std::vector<int> intervals;
  RefineOptions options{.tolerance = mesh_tolerance(CertificateGrade::draft)};
  options.on_round = [&](const RefineRound& round) { intervals.push_back(round.intervals); };
  const RefinedPlan refined = refine(task, RiccatiSolver(), {.coarse_first = false}, options);
  EXPECT_TRUE(refined.meets_tolerance);
  EXPECT_TRUE(refined.plan.certificate.passed);
  EXPECT_EQ(intervals.front(), 320);
  EXPECT_LT(refined.plan.mesh.num_intervals(), 110);
  EXPECT_EQ(refined.plan.mesh.num_intervals(), *std::ranges::min_element(intervals))
      << "the smallest that meets the tolerance";
  EXPECT_EQ(refined.plan.levels.size(), intervals.size());
}

TEST(Refine, TakesEverySolverOfPlan) {
  const Task task = read("step");
  for (const char* name : {"riccati", "fatrop", "ipopt"}) {
    const RefinedPlan refined = refine(task, *make_solver(name));
    EXPECT_TRUE(refined.meets_tolerance) << name;
    EXPECT_TRUE(refined.plan.certificate.passed) << name;
    EXPECT_LT(refined.plan.mesh.num_intervals(), 125) << name;
  }
}

TEST(Refine, BooksAreOfAllMeshes) {
  const Task task = read("step");
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
    EXPECT_EQ(rounds[i].too_coarse == 0, i + 1 == rounds.size());
    iterations += rounds[i].iterations;
  }
  EXPECT_EQ(refined.plan.result.iterations, iterations);
  EXPECT_LE(rounds.front().intervals, 48) << "from a coarse mesh";
  EXPECT_GT(rounds.front().errors.local, 10.0 * rounds.back().errors.local);
}

/// Out of reach in two meshes: the better one, and word of it.
TEST(Refine, TellsWhatItDidNotReach) {
  const Task task = read("step");
  const RefinedPlan refined =
      refine(task, RiccatiSolver(), {}, {.tolerance = mesh_tolerance(CertificateGrade::certified), .max_rounds = 2});
  EXPECT_FALSE(refined.meets_tolerance);
  EXPECT_EQ(refined.plan.result.status, SolveStatus::converged);
  EXPECT_EQ(refined.plan.mesh.num_intervals(), refined.plan.levels.back().intervals);
  ASSERT_EQ(refined.plan.hints.size(), 1u);
  EXPECT_THAT(refined.plan.hints[0], HasSubstr("mesh refinement stopped, after 2 meshes: "));
}

/// What there is stays, and an interrupt is known as one.
TEST(Refine, KeepsTheLastMotionThatConverged) {
  const Task task = read("step");
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
    EXPECT_EQ(refined.plan.levels.size(), 3u);
    ASSERT_EQ(refined.plan.hints.size(), 1u);
    EXPECT_THAT(refined.plan.hints[0], HasSubstr(to_string(status)));
  }
}

/// Not of the coarsest, if that fails: the next finer one is tried, from the task.
TEST(Refine, BeginsOnTheFirstMeshThatConverges) {
  const Task task = read("step");
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

/// No mesh is solved twice, also where the sum of errors over a second is what holds the mesh.
TEST(Refine, DoesNotGoRoundInCircles) {
  for (const double tolerance : {0.02, 5.0}) {
    std::vector<int> intervals;
    RefineOptions options{.tolerance = mesh_tolerance(tolerance)};
    options.on_round = [&](const RefineRound& round) { intervals.push_back(round.intervals); };
    const RefinedPlan refined = refine(read("crouch"), RiccatiSolver(), {}, options);
    EXPECT_TRUE(refined.meets_tolerance);
    EXPECT_LT(intervals.size(), 6u) << tolerance;
    std::ranges::sort(intervals);
    EXPECT_EQ(std::ranges::adjacent_find(intervals), intervals.end()) << tolerance;
  }
}

TEST(Refine, BeginsNoMeshWhenTheTimeIsUp) {
  Task task = read("step");
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
