#include "prowl/model/configuration.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace prowl {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kJoints = 4;

VectorXd random_vector(std::mt19937& rng, int size) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return VectorXd::NullaryExpr(size, [&] { return uniform(rng); });
}

VectorXd random_configuration(std::mt19937& rng) {
  VectorXd q = random_vector(rng, 7 + kJoints);
  q.segment<4>(3).normalize();
  return q;
}

TEST(Configuration, DifferenceUndoesIntegrate) {
  std::mt19937 rng(1);
  for (int i = 0; i < 1000; ++i) {
    const VectorXd q = random_configuration(rng);
    const VectorXd d = random_vector(rng, 6 + kJoints);
    EXPECT_LT((difference(q, integrate(q, d)) - d).norm(), 1e-13);
    EXPECT_NEAR(integrate(q, d).segment<4>(3).norm(), 1.0, 1e-15);
  }
}

TEST(Configuration, IntegrateReachesTheOtherEndOfADifferenceOnTheShortWay) {
  std::mt19937 rng(2);
  for (int i = 0; i < 1000; ++i) {
    const VectorXd q0 = random_configuration(rng), q1 = random_configuration(rng);
    const VectorXd d = difference(q0, q1);
    const VectorXd reached = integrate(q0, d);
    EXPECT_LE(d.segment<3>(3).norm(), std::numbers::pi + 1e-12);
    EXPECT_LT((base_rotation(reached) - base_rotation(q1)).norm(), 1e-13);
    EXPECT_LT((base_position(reached) - base_position(q1)).norm(), 1e-14);
    EXPECT_LT((reached - q1).tail(kJoints).norm(), 1e-14);
  }
}

TEST(Configuration, DisplacementIsInTheWorldAndRotationInTheBase) {
  VectorXd q = VectorXd::Zero(7);
  set_base_rotation(q, rotation_from_rpy({0.0, 0.0, std::numbers::pi / 2.0}));  // looks along world y
  VectorXd d = VectorXd::Zero(6);
  d << 1.0, 0.0, 0.0, std::numbers::pi / 2.0, 0.0, 0.0;  // along world x, roll about its own x
  const VectorXd moved = integrate(q, d);
  EXPECT_LT((base_position(moved) - Vector3d::UnitX()).norm(), 1e-15);
  // Its own x axis still looks along world y, and its z axis, turned about world y, along world x.
  EXPECT_LT((base_rotation(moved).col(0) - Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((base_rotation(moved).col(2) - Vector3d::UnitX()).norm(), 1e-15);
}

TEST(Configuration, SmallStepsKeepTheirDigits) {
  std::mt19937 rng(3);
  VectorXd q = random_configuration(rng);
  q.head<3>().setZero();
  VectorXd d = VectorXd::Zero(6 + kJoints);
  d.segment<3>(3) = 1e-9 * Vector3d(1.0, -2.0, 3.0);
  EXPECT_LT((difference(q, integrate(q, d)) - d).norm(), 1e-6 * d.norm());
  EXPECT_EQ(integrate(q, VectorXd::Zero(6 + kJoints)).head<3>(), q.head<3>());
}

TEST(Configuration, QuaternionNeverChangesSignAlongAMotion) {
  VectorXd q = VectorXd::Zero(7);
  q(6) = 1.0;
  VectorXd step = VectorXd::Zero(6);
  step(5) = 0.1;
  for (int i = 0; i < 200; ++i) {  // three turns
    const VectorXd next = integrate(q, step);
    EXPECT_GT(next.segment<4>(3).dot(q.segment<4>(3)), 0.99);
    q = next;
  }
}

TEST(Configuration, RollPitchYawTurnInThisOrder) {
  const Eigen::Matrix3d R = rotation_from_rpy({0.1, 0.2, 0.3});
  // Yaw is where the x axis points in the plane, pitch how far it dips, roll what the y axis climbs.
  EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)), 0.3, 1e-15);
  EXPECT_NEAR(-std::asin(R(2, 0)), 0.2, 1e-15);
  EXPECT_NEAR(std::atan2(R(2, 1), R(2, 2)), 0.1, 1e-15);
}

}  // namespace
}  // namespace prowl
