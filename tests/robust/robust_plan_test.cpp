#include "prowl/robust/robust_plan.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "prowl/error.hpp"
#include "prowl/session/plan_task.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

PlannedTask plan(const std::string& name, const std::string& more = "") {
  const std::filesystem::path file = std::string(PROWL_SOURCE_DIR) + "/tasks/" + name + ".toml";
  SourceText text = read_text_file(file);
  text.text = more + text.text;
  return plan_task(read_task_text(text, test::test_search(), {.robust = true}), {});
}

/// Least of mu fn - |ft| over the nodes and contacts of the plan, with this share of the friction [N].
double least_cone(const PlanRecord& record, double friction) {
  double least = std::numeric_limits<double>::infinity();
  const MotionProblem& problem = record.task.problem;
  for (const TrajectoryPoint& node : record.plan.trajectory.nodes) {
    for (const PhaseContact& held : problem.phases[node.phase].contacts) {
      const Surface& surface = problem.surfaces[held.surface];
      const Eigen::Vector3d force = node.force.segment<3>(3 * held.contact);
      const double normal = surface.normal.dot(force);
      least = std::min(least, friction * surface.friction * normal - (force - normal * surface.normal).norm());
    }
  }
  return least;
}

TEST(RobustPlan, LeavesWhatItsTubeNeeds) {
  const PlannedTask planned = plan("hyq/step");
  const PlanRecord& record = planned.record;
  ASSERT_TRUE(is_good(record.plan));
  ASSERT_TRUE(record.robustness && record.feedback);
  const Robustness& robustness = *record.robustness;
  EXPECT_GT(robustness.share, 0.5) << robustness.tightest;
  EXPECT_GT(robustness.solves, 0);
  EXPECT_NE(robustness.tightest.find(" s in phase '"), std::string::npos) << robustness.tightest;

  const MotionProblem& problem = record.task.problem;
  const Tube tube = make_tube(problem, record.plan.trajectory, record.task.tracking, robustness.sizes);
  // Of each contact and joint by itself. Margins of less than a tenth of the largest are below what a solve sees.
  const auto expect_left = [&](const Eigen::MatrixXd& left, const Eigen::MatrixXd& needed) {
    constexpr double kMissing = 0.2;  // of a margin: the next tube would differ by as much
    for (Eigen::Index row = 0; row < needed.rows(); ++row) {
      const double largest = std::max(needed.row(row).maxCoeff(), 0.1 * needed.maxCoeff());
      EXPECT_GE((left.row(row) - robustness.share * needed.row(row)).minCoeff(),
                -kMissing * robustness.share * largest - 1e-9)
          << "row " << row;
    }
  };
  for (const Tube::OfPhase& phase : tube.phases) {
    expect_left(phase.torque_left, phase.needed.torque);
    expect_left(phase.cone_left, phase.cone_needed());
  }
}

/// Without any deviation, less friction alone has to be kept.
TEST(RobustPlan, KeepsFrictionThatMayBeMissing) {
  std::string sizes = "friction = 0.75";
  for (const DisturbanceKey& key : kDisturbanceKeys)
    if (key.size != &Disturbances::friction && key.size != &Disturbances::push_duration)
      sizes += fmt::format(", {} = 0.0", key.name);
  const PlannedTask planned = plan("hyq/step", "robust = { " + sizes + " }\n");
  ASSERT_TRUE(planned.record.robustness);
  EXPECT_EQ(planned.record.robustness->share, 1.0) << planned.record.robustness->tightest;
  EXPECT_GT(planned.record.robustness->solves, 0) << "the nominal plan uses its friction up";
  EXPECT_GE(least_cone(planned.record, 0.25), -1e-3 * planned.record.task.problem.robot.weight());
}

TEST(RobustPlan, HasMoreLeftThanTheNominalOne) {
  const PlannedTask planned = plan("hyq/step");
  const Task& task = planned.record.task;
  const Trajectory nominal = test::solve_task("hyq/step").trajectory, &robust = planned.record.plan.trajectory;
  const auto least = [&](const Trajectory& motion) {  // [N]
    double left = std::numeric_limits<double>::infinity();
    for (const Tube::OfPhase& phase :
         make_tube(task.problem, motion, task.tracking, planned.record.robustness->sizes).phases)
      left = std::min(left, (phase.cone_left - phase.cone_needed()).minCoeff());
    return left;
  };
  EXPECT_GT(least(robust), least(nominal) + 0.01 * task.problem.robot.weight());
}

/// A base that may be 20 cm off, on feet that bear no more than their share.
TEST(RobustPlan, TellsWhatCannotBe) {
  const PlannedTask planned = plan("hyq/stand", "robust = { base_position_m = 0.2, center_m = 0.2 }\n");
  ASSERT_TRUE(planned.record.robustness);
  EXPECT_LT(planned.record.robustness->share, 0.5);
  EXPECT_FALSE(planned.record.robustness->tightest.empty());
  EXPECT_TRUE(is_good(planned.record.plan)) << "the best plan is kept";
}

/// Of the shipped step, from its nominal plan on that mesh.
RobustPlan robust_step(const NlpSolver& solver) {
  const Task task = read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/step.toml", test::test_search());
  Plan nominal = test::planned(task);
  if (!is_good(nominal)) throw std::runtime_error("no good plan");
  return make_robust_plan({task.problem, nominal.mesh}, nominal, task.tracking,
                          default_disturbances(task.problem.robot), solver, {.solver = task.solver}, std::nullopt);
}

/// Takes loose solves only: margins that leave nothing between two limits, on the mesh of the last solve alone.
class OnlyLoose : public RiccatiSolver {
 public:
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) const override {
    if (options.tolerance < 1e-5) throw InputError("bounds contain no interior");
    return RiccatiSolver::solve(nlp, z_guess, options);
  }
};

TEST(RobustPlan, IsTheNominalOneWhereTheLastSolveIsRefused) {
  const RobustPlan robust = robust_step(OnlyLoose());
  EXPECT_GT(robust.robustness.solves, 0);
  EXPECT_LT(robust.robustness.share, 1.0);
  EXPECT_FALSE(robust.is_stopped);
  EXPECT_TRUE(is_good(robust.plan));
}

/// Has no time for loose solves.
class NoTime : public RiccatiSolver {
 public:
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) const override {
    SolveResult result = RiccatiSolver::solve(nlp, z_guess, options);
    if (options.tolerance > 1e-5) result.status = SolveStatus::time_limit;
    return result;
  }
};

TEST(RobustPlan, TellsThatTimeEndedTheSearch) {
  const RobustPlan robust = robust_step(NoTime());
  EXPECT_TRUE(robust.is_stopped);
  EXPECT_LT(robust.robustness.share, 1.0);
  EXPECT_NE(robust.plan.hints.back().find("more time"), std::string::npos);
}

TEST(RobustPlan, OfNothingIsTheNominalOne) {
  const PlannedTask planned = plan(
      "hyq/stand",
      "robust = { base_position_m = 0, base_angle_rad = 0, base_velocity_mps = 0, base_rate_radps = 0, mass = 0, "
      "center_m = 0, friction = 0, push_mps = 0, ground_m = 0, estimate_position_m = 0, estimate_angle_rad = 0 }\n");
  ASSERT_TRUE(planned.record.robustness);
  EXPECT_EQ(planned.record.robustness->share, 1.0);
  EXPECT_EQ(planned.record.robustness->solves, 0);
}

}  // namespace
}  // namespace prowl
