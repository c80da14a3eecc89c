#include "prowl/robust/robust_plan.hpp"

#include <gtest/gtest.h>

#include "prowl/session/plan_task.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

constexpr double kSolved = 1e-3;  // of the weight; solver and interpolation

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
  const Tube tube = closed_loop(problem, record.plan.trajectory, record.task.tracking, robustness.sizes).tube;
  const double weight = problem.robot.weight();
  for (std::size_t p = 0; p < tube.phases.size(); ++p) {
    const Tube::OfPhase& phase = tube.phases[p];
    constexpr double kMissing = 0.2;  // of a margin: the next tube would differ by as much
    EXPECT_GT((phase.torque_left - robustness.share * phase.needed.torque).minCoeff(),
              -kMissing * robustness.share * phase.needed.torque.maxCoeff());
    const Eigen::MatrixXd slippery =
        robustness.share * robustness.sizes.friction * problem.surfaces.front().friction * phase.load;
    EXPECT_GT((phase.cone_left - slippery - robustness.share * phase.needed.cone).minCoeff(),
              -kMissing * robustness.share * phase.needed.cone.maxCoeff() - kSolved * weight);
  }
}

TEST(RobustPlan, HasMoreLeftThanTheNominalOne) {
  const PlanRecord robust = plan("hyq/stand").record;
  const test::SolvedTask solved = test::solve_task("hyq/stand");
  const PlanRecord nominal{.task = solved.task, .plan = {.trajectory = solved.trajectory}, .versions = {}};
  ASSERT_TRUE(is_good(robust.plan));
  EXPECT_GT(least_cone(robust, 0.8), least_cone(nominal, 0.8) + 0.01 * robust.task.problem.robot.weight());
}

/// A base that may be 20 cm off, on feet that bear no more than their share.
TEST(RobustPlan, TellsWhatCannotBe) {
  const PlannedTask planned = plan("hyq/stand", "robust = { base_position_m = 0.2, center_m = 0.2 }\n");
  ASSERT_TRUE(planned.record.robustness);
  EXPECT_LT(planned.record.robustness->share, 0.5);
  EXPECT_FALSE(planned.record.robustness->tightest.empty());
  EXPECT_TRUE(is_good(planned.record.plan)) << "the best plan is kept";
}

TEST(RobustPlan, OfNothingIsTheNominalOne) {
  const PlannedTask planned =
      plan("hyq/stand",
           "robust = { base_position_m = 0, base_angle_rad = 0, base_velocity_mps = 0, base_rate_radps = 0, mass = 0, "
           "center_m = 0, friction = 0, push_mps = 0 }\n");
  ASSERT_TRUE(planned.record.robustness);
  EXPECT_EQ(planned.record.robustness->share, 1.0);
  EXPECT_EQ(planned.record.robustness->solves, 0);
}

}  // namespace
}  // namespace prowl
