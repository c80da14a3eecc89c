#include "prowl/mpc/state_prediction.hpp"

#include <gtest/gtest.h>

#include "prowl/dynamics/centroidal_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/mpc/standing_robot.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// A robot whose plan holds the torques of its standing posture for a second.
class StatePredictionOf : public testing::TestWithParam<RobotDescription (*)()> {
 protected:
  StatePredictionOf() {
    plan = standing_step(robot, feet, q);
    plan.length = 1.0;
  }
  void predict(double from, double to) { prediction.predict(plans, timeline, from, to, q, v); }
  /// All feet swing until 0.4 s.
  void lift() {
    SteppingPattern jump{.groups = {{}}, .stride = 0.5, .duty_factor = 0.2};
    for (int f = 0; f < static_cast<int>(feet.size()); ++f) jump.groups.front().push_back(f);
    timeline.follow(jump);
    timeline.extend(0.0, 0.3);
  }
  void move() {
    std::mt19937 rng(7);
    q = integrate(q, test::random_vector(rng, robot.nv(), 0.1));
    v = test::random_vector(rng, robot.nv(), 0.5);
    plan.tau += test::random_vector(rng, robot.nu(), 5.0);
  }

  RobotModel robot{GetParam()()};
  std::vector<std::vector<int>> feet = contacts_of_feet(robot);
  VectorXd q = standing_on_ground(robot), v = VectorXd::Zero(robot.nv());
  LatestPlans plans{robot, MpcPlan(robot, 1)};
  MpcPlan::Step& plan = plans.begin_next().steps().front();
  ContactTimeline timeline{static_cast<int>(feet.size()), 0.0};
  StatePrediction prediction{robot, feet};
};

TEST_P(StatePredictionOf, ARobotThatStandsStaysThere) {
  const VectorXd before = q;
  predict(0.0, 0.05);
  EXPECT_LT(difference(before, q).norm(), 1e-9);
  EXPECT_LT(v.norm(), 1e-7);
}

/// Whatever its joints do, its centre of mass falls. The tolerance is for steps of first order.
TEST_P(StatePredictionOf, ARobotInTheAirFalls) {
  lift();
  move();
  CentroidalKinematics centroidal(robot);
  centroidal.update(q, v);
  const Vector3d com = centroidal.com();
  const auto before = centroidal.momentum();
  constexpr double kTime = 0.02;
  predict(0.0, kTime);
  centroidal.update(q, v);
  const Vector3d gained = (centroidal.momentum() - before).head<3>() / robot.weight() * RobotModel::kGravity;
  EXPECT_LT((gained - Vector3d(0.0, 0.0, -RobotModel::kGravity * kTime)).norm(), 0.1 * RobotModel::kGravity * kTime);
  const Vector3d velocity = before.head<3>() / robot.weight() * RobotModel::kGravity;
  EXPECT_LT((centroidal.com() - com - kTime * velocity).norm(), RobotModel::kGravity * kTime * kTime);
}

TEST_P(StatePredictionOf, IsNearThatWithShortSteps) {
  move();
  const VectorXd q_before = q, v_before = v;
  predict(0.0, 0.012);
  const VectorXd q_coarse = q, v_coarse = v;
  q = q_before;
  v = v_before;
  constexpr int kSteps = 240;
  for (int i = 0; i < kSteps; ++i) predict(i * 0.012 / kSteps, (i + 1) * 0.012 / kSteps);
  EXPECT_LT(difference(q, q_coarse).norm(), 0.03 * difference(q, q_before).norm());
  EXPECT_LT((v - v_coarse).norm(), 0.1 * (v - v_before).norm());
}

TEST_P(StatePredictionOf, NothingHappensInNoTime) {
  move();
  const VectorXd q_before = q, v_before = v;
  predict(0.01, 0.01);
  predict(0.01, 0.005);
  EXPECT_EQ(q, q_before);
  EXPECT_EQ(v, v_before);
}

INSTANTIATE_TEST_SUITE_P(StatePrediction, StatePredictionOf,
                         testing::Values(&test::hyq_description, &test::talos_description));

}  // namespace
}  // namespace prowl
