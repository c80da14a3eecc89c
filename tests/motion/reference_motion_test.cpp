#include "prowl/motion/reference_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "prowl/error.hpp"
#include "prowl/model/body_placements.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/robot_frame.hpp"
#include "prowl/motion/term_evaluation.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

ReferenceMotion random_reference(const RobotModel& robot) {
  std::mt19937 rng(6);
  ReferenceMotion reference{Vector3d(0.0, 0.4, 1.0), Eigen::MatrixXd(robot.nq(), 3)};
  for (auto q : reference.q.colwise())
    q = integrate(robot.nominal_configuration(), test::random_vector(rng, robot.nv(), 0.4));
  return reference;
}

/// Sum of the costs at one posture.
double cost_at(const RobotModel& robot, const std::vector<TermUse>& uses, const VectorXd& q, double time) {
  RigidBodyTerms kinematics(robot);
  kinematics.update_kinematics(q);
  const VectorXd v = VectorXd::Zero(robot.nv()), tau = VectorXd::Zero(robot.nu()), none;
  double cost = 0.0;
  for (const TermUse& use : uses) {
    TermEvaluation term(robot, use, {});
    term.evaluate({kinematics, q, v, tau, none, time});
    cost += 0.5 * term.value().dot(use.weight * term.value());
  }
  return cost;
}

TEST(ReferenceMotion, PassesThroughItsPosturesTheShortestWay) {
  const RobotModel robot = test::hyq();
  const ReferenceMotion reference = random_reference(robot);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(difference(reference.q.col(k), reference.at(reference.times(k))).norm(), 1e-12);
  }
  EXPECT_EQ(reference.at(-1.0), reference.q.col(0));
  EXPECT_EQ(reference.at(2.0), reference.q.col(2));
  const VectorXd half = reference.at(0.7);
  EXPECT_LT((difference(reference.q.col(1), half) - 0.5 * difference(reference.q.col(1), reference.q.col(2))).norm(),
            1e-12);
}

TEST(ReferenceCosts, AreHalfOfTheWeightsTimesTheSquaredDeviations) {
  const RobotModel robot = test::hyq();
  const ReferenceMotion reference = random_reference(robot);
  ReferenceWeights weights{.base_position = {1.0, 2.0, 3.0},
                           .base_orientation = 5.0,
                           .joint_position = VectorXd::LinSpaced(robot.nu(), 1.0, 2.0),
                           .frames = {{"lf_foot", 7.0}}};
  const auto costs = reference_costs(robot, reference, weights, 2);
  ASSERT_EQ(costs.size(), 4u);
  EXPECT_NEAR(cost_at(robot, costs, reference.q.col(1), 0.4), 0.0, 1e-20);

  std::mt19937 rng(7);
  const VectorXd off = test::random_vector(rng, robot.nv(), 0.3);
  const VectorXd q = integrate(reference.q.col(1), off);
  const RobotFrame foot = robot_frame(robot, "lf_foot");
  BodyPlacements bodies(robot);
  const auto foot_at = [&](const VectorXd& posture) -> Vector3d {
    return bodies.at(posture)[foot.body] * foot.placement.translation();
  };
  const double expected = 0.5 * weights.base_position.dot(off.head<3>().cwiseAbs2()) +
                          5.0 * (1.0 - std::cos(off.segment<3>(3).norm())) +
                          0.5 * weights.joint_position.dot(off.tail(robot.nu()).cwiseAbs2()) +
                          3.5 * (foot_at(q) - foot_at(reference.q.col(1))).squaredNorm();
  EXPECT_NEAR(cost_at(robot, costs, q, 0.4), expected, 1e-10 * expected);
}

TEST(ReferenceCosts, AreThoseWithWeights) {
  const RobotModel robot = test::hyq();
  const ReferenceMotion reference = random_reference(robot);
  ReferenceWeights weights{.joint_position = VectorXd::Zero(robot.nu())};
  EXPECT_TRUE(reference_costs(robot, reference, weights, 1).empty());
  weights.joint_position(3) = 1.0;
  EXPECT_EQ(reference_costs(robot, reference, weights, 1).at(0).name, "reference joint_position");
  weights.frames = {{"lf_fot", 1.0}};
  EXPECT_THROW(reference_costs(robot, reference, weights, 1), InputError);
}

}  // namespace
}  // namespace prowl
