#include "prowl/online/outside_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "prowl/error.hpp"
#include "prowl/online/online_run.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

constexpr double kTakes = 0.025;  ///< computing time that the planner tells [s]

/// Holds the standing posture with springs and dampers in the joints.
struct Holding {
  RobotModel robot{test::hyq_description()};
  VectorXd q = standing_on_ground(robot);
  long requests = 0;
  double last_start = 0.0;

  std::optional<double> operator()(const MotionRequest& request, std::vector<MpcPlan::Step>& steps) {
    ++requests;
    last_start = request.start;
    EXPECT_EQ(request.q.size(), robot.nq());
    steps = {standing_step(robot, contacts_of_feet(robot), q)};
    MpcPlan::Step& step = steps.front();
    step.start = request.start;
    step.length = 0.2;
    step.gain.block(0, 6, 12, 12).diagonal().setConstant(-400.0);
    step.gain.rightCols(12).diagonal().setConstant(-15.0);
    return kTakes;
  }

  OnlineResult run(LatePlans late, const Planner& planner) {
    OnlineOptions options;
    options.gait = "stand";
    options.duration = 2.0;
    options.late = late;
    options.planner = planner;
    return run_online(robot, options);
  }
};

TEST(OutsideController, StandsByItsPlanner) {
  Holding hold;
  const OnlineResult result = hold.run(LatePlans::act, std::ref(hold));
  EXPECT_TRUE(result.success()) << result.failures.front();
  EXPECT_EQ(result.counters.failed, 0);
  EXPECT_EQ(hold.requests, 200);
  for (const double seconds : result.times) EXPECT_EQ(seconds, kTakes);
}

TEST(OutsideController, IsToldThatItDidNotFollowItsCommand) {
  Holding hold;
  OnlineOptions options;
  options.duration = 2.0;  // of a trot, which the planner does not do
  options.planner = std::ref(hold);
  options.commands = {{.time = 0.0, .command = {.forward = 0.3}}};
  const OnlineResult result = run_online(hold.robot, options);
  EXPECT_NEAR(result.last_velocity.value(), 0.3, 0.02);
  ASSERT_EQ(result.failures.size(), 1U);
  EXPECT_NE(result.failures.front().find("off the command"), std::string::npos) << result.failures.front();
}

TEST(OutsideController, WaitsForPlansThatTakeLong) {
  Holding hold;
  const OnlineResult result = hold.run(LatePlans::wait, std::ref(hold));
  EXPECT_TRUE(result.success()) << result.failures.front();
  const double control_period = SimulationOptions{}.control_period();
  const double each = std::ceil(kTakes / control_period - 1e-9) * control_period;
  EXPECT_EQ(hold.requests, std::lround(std::ceil(2.0 / each - 1e-9)));
}

TEST(OutsideController, DropsPlansThatTakeLong) {
  Holding hold;
  const OnlineResult result = hold.run(LatePlans::drop, std::ref(hold));
  EXPECT_EQ(result.dropped, result.counters.updates);
}

TEST(OutsideController, WithoutAPlanTheLastOneGoesOnThenJointsAreDamped) {
  Holding hold;
  const OnlineResult none = hold.run(LatePlans::act, [](const auto&, auto&) { return std::nullopt; });
  EXPECT_EQ(none.counters.failed, none.counters.updates);
  EXPECT_GT(none.counters.damped, 0);
  EXPECT_FALSE(none.success());
  const OnlineResult bad = hold.run(LatePlans::act, [&](const MotionRequest& request, auto& steps) {
    const std::optional<double> seconds = hold(request, steps);
    if (request.time > 0.5) steps.front().gain(0, 0) = std::numeric_limits<double>::quiet_NaN();
    return seconds;
  });
  EXPECT_EQ(bad.counters.updates - bad.counters.failed, 51) << "plans at 0 to 0.5 s";
  EXPECT_LE(bad.largest_torque_share, 1.0 + 1e-12);
}

TEST(OutsideController, AsksFromTheStateAtTheStartOfAPlan) {
  Holding hold;
  const VectorXd q = hold.q, still = VectorXd::Zero(hold.robot.nv());
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();
  OutsideController controller(
      hold.robot,
      [&](const MotionRequest& request, std::vector<MpcPlan::Step>& steps) {
        expected = request.q.head<3>();
        return hold(request, steps);
      },
      0.012, q, 0.0);
  VectorXd v = still;
  v(0) = 0.1;
  ASSERT_TRUE(controller.update(q, v, 0.3));
  EXPECT_DOUBLE_EQ(hold.last_start, 0.312);
  EXPECT_NEAR(expected.x() - q.x(), 0.012 * 0.1, 5e-4);
}

TEST(OutsideController, RefusesUnknownFatesOfLatePlans) {
  EXPECT_EQ(late_plans_named("wait"), LatePlans::wait);
  EXPECT_THROW(late_plans_named("never"), InputError);
}

}  // namespace
}  // namespace prowl
