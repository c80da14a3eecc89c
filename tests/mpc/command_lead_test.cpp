#include "prowl/mpc/command_lead.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "prowl/model/configuration.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kPeriod = 0.01;  // [s]

struct Led {
  HorizonProgram program{RobotModel(test::hyq_description()), MpcWeights{}, 0.6, 20};
  VectorXd q = program.standing_posture();
  CommandLead lead{program.standing_posture(), q, 0.0};
  HorizonGrid grid{20, 0.015, 0.6};
  ContactTimeline timeline{4, 0.0};
  GroundPlane ground{4, 0.8};
  double t = 0.0;

  Led() { lead.stand(false); }

  void advance(double duration) {
    for (const double end = t + duration; t < end - 1e-9;) lead.advance(t += kPeriod);
  }
};

TEST(CommandLead, StaysWithoutACommand) {
  Led led;
  led.advance(3.0);
  EXPECT_EQ(led.lead.pose(), Vector3d(led.q.x(), led.q.y(), 0.0));
}

TEST(CommandLead, ReturnsWhatLegsAllow) {
  Led led;
  const double none = std::numeric_limits<double>::quiet_NaN();
  const MpcCommand most = led.lead.command({1e3, 1e3, 1e3, 1e3});
  EXPECT_EQ(led.lead.command({0.5 * most.forward, 0.0, none, 0.0}), MpcCommand({0.5 * most.forward, 0.0, 0.0, 0.0}));
  EXPECT_EQ(led.lead.command({-1e3, -1e3, -1e3, -1e3}),
            MpcCommand({-most.forward, -most.left, -most.turn, -most.height}));
  // A walk faster than sqrt(g height) would leave the ground.
  EXPECT_LT(most.forward, std::sqrt(RobotModel::kGravity * led.q.z()));
  EXPECT_LT(most.left, most.forward);
}

TEST(CommandLead, ARobotThatStandsFollowsNoVelocity) {
  Led led;
  const MpcCommand asked{0.3, 0.1, 0.2, 0.02};
  EXPECT_EQ(led.lead.command(asked), asked);
  led.advance(3.0);
  led.lead.stand(true);
  EXPECT_EQ(led.lead.command(asked), MpcCommand({0.0, 0.0, 0.0, 0.02}));
  led.advance(3.0);
  const Vector3d place = led.lead.pose();
  led.advance(1.0);
  EXPECT_EQ(led.lead.pose(), place);
  EXPECT_NEAR(led.lead.followed().height, 0.02, 1e-12);
  led.lead.stand(false);
  led.advance(3.0);
  EXPECT_EQ(led.lead.followed(), asked) << "the command is remembered";
}

/// Acceleration and deceleration are those that friction 0.6 allows, with a reserve.
TEST(CommandLead, ChangesSmoothly) {
  Led led;
  led.lead.command({0.5, -0.3, 0.4, 0.02});
  double before = 0.0, most = 0.0;
  for (int i = 0; i < 200; ++i) {
    if (i == 100) led.lead.command({});
    if (i == 99) EXPECT_EQ(led.lead.followed(), MpcCommand({0.5, -0.3, 0.4, 0.02}));
    led.advance(kPeriod);
    most = std::max(most, std::abs(led.lead.followed().forward - before) / kPeriod);
    before = led.lead.followed().forward;
  }
  EXPECT_EQ(led.lead.followed(), MpcCommand{});
  EXPECT_GT(most, 0.0);
  EXPECT_LT(most, 0.3 * RobotModel::kGravity);
}

TEST(CommandLead, LeadsAlongACircle) {
  Led led;
  led.lead.command({0.3, 0.0, 0.5, 0.0});
  led.advance(2.0);
  const Vector3d begin = led.lead.pose();
  const double radius = 0.3 / 0.5;
  led.advance(std::numbers::pi / 0.5);
  const Vector3d half = led.lead.pose();
  EXPECT_NEAR((half - begin).head<2>().norm(), 2.0 * radius, 0.01);
  led.advance(std::numbers::pi / 0.5);
  EXPECT_LT((led.lead.pose() - begin).head<2>().norm(), 0.01);
}

TEST(CommandLead, ReferencesAreWhereItWillLead) {
  Led led;
  led.lead.command({0.3, 0.1, 0.5, 0.02});
  led.advance(2.0);
  led.grid.lay(led.t, led.timeline);
  led.lead.lead(led.t, led.grid, led.ground, led.program);
  for (int k = 0; k < led.program.num_stages(); ++k) {
    led.lead.advance(led.grid.middle(k));
    const Vector3d pose = led.lead.pose();
    const HorizonStep& step = led.program.step(k);
    EXPECT_LT((step.q_ref.head<2>() - pose.head<2>()).norm(), 2e-3) << k;
    EXPECT_NEAR(heading(step.q_ref), pose.z(), 1e-9) << k;
    EXPECT_NEAR(step.q_ref.z(), led.q.z() + 0.02, 1e-12);
    EXPECT_EQ(step.v_ref.head<2>(), Vector2d(0.3, 0.1));
    EXPECT_EQ(step.v_ref(5), 0.5);
    EXPECT_EQ(step.q_ref.tail(12), led.q.tail(12));
  }
}

TEST(CommandLead, ReferencesAreParallelToTheGround) {
  Led led;
  for (int contact = 0; contact < 4; ++contact) {
    const Vector2d place(contact % 2 == 0 ? 0.3 : -0.3, contact < 2 ? 0.2 : -0.2);
    led.ground.see(contact, {place.x(), place.y(), 0.2 * place.x() - 0.1 * place.y()});
  }
  led.ground.fit(1.0);
  led.lead.lead(kPeriod, led.grid, led.ground, led.program);
  const VectorXd& q_ref = led.program.step(0).q_ref;
  EXPECT_LT(led.ground.normal().x(), -0.15);
  EXPECT_LT((base_rotation(q_ref).col(2) - led.ground.normal()).norm(), 1e-9);
  EXPECT_NEAR(q_ref.z() - led.q.z(), led.ground.height(q_ref.head<2>()), 1e-9);
}

TEST(CommandLead, StaysNearARobotThatWasPushed) {
  Led led;
  constexpr double kSize = 0.8;  // [m]
  VectorXd near = led.q;
  near.x() += 0.01;
  led.lead.stay_near(near, kSize);
  EXPECT_EQ(led.lead.pose().x(), led.q.x()) << "a robot that sways is led back";
  VectorXd q = led.q;
  q.head<2>() += Vector2d(3.0, 4.0);
  set_base_rotation(q, Eigen::AngleAxisd(3.0, Vector3d::UnitZ()).toRotationMatrix());
  led.lead.stay_near(q, kSize);
  const Vector3d pose = led.lead.pose();
  EXPECT_LE((pose.head<2>() - q.head<2>()).norm(), 0.1 * kSize + 1e-12);
  EXPECT_NEAR((pose.head<2>() - q.head<2>()).normalized().dot(Vector2d(-0.6, -0.8)), 1.0, 1e-12);
  EXPECT_LT(std::abs(std::remainder(pose.z() - 3.0, 2.0 * std::numbers::pi)), 0.2);
}

}  // namespace
}  // namespace prowl
