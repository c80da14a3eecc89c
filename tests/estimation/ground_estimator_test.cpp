#include "prowl/estimation/ground_estimator.hpp"

#include <gtest/gtest.h>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

constexpr double kStep = 1e-3;

/// HyQ stands as planned, on ground that is not where the plan has it.
class GroundEstimatorTest : public ::testing::Test {
 protected:
  Stand stand_{std::vector<bool>(4, true), std::vector<Eigen::Vector3d>(4, Eigen::Vector3d::UnitZ())};
  RobotModel robot_ = test::hyq();
  Eigen::VectorXd planned_ = robot_.nominal_configuration();
  GroundEstimator estimator_{robot_, planned_, stand_, std::vector<bool>(4, true)};

  Eigen::Vector3d position(const Eigen::VectorXd& q, int contact) const {
    RigidBodyTerms terms(robot_);
    terms.update_kinematics(q);
    return terms.contact_position(contact);
  }
  /// Where a point of the planned ground is.
  static Eigen::Vector3d moved(const Eigen::Vector3d& p) {
    return p + Eigen::Vector3d(0.0, 0.0, 0.004) + Eigen::Vector3d(0.02, -0.03, 0.0).cross(p);
  }
  /// The planned posture with these feet on the ground as it is.
  Eigen::VectorXd standing(const std::vector<int>& feet) const {
    std::vector<ContactTarget> targets;
    for (const int foot : feet) targets.push_back({foot, moved(position(planned_, foot))});
    return inverse_kinematics(robot_, planned_, targets).q;
  }
  void stand(const Eigen::VectorXd& q, double seconds) {
    for (int i = 0; i * kStep < seconds; ++i) estimator_.update(kStep, q, planned_, stand_, stand_);
  }
};

TEST_F(GroundEstimatorTest, FindsHeightAndTiltUnderFourFeet) {
  stand(standing({0, 1, 2, 3}), 1.0);
  for (int foot = 0; foot < 4; ++foot) {
    const Eigen::Vector3d p = position(planned_, foot);
    EXPECT_LT((estimator_.displacement(p) - (moved(p) - p)).norm(), 1e-3);
  }
  EXPECT_LT((estimator_.tilt() - Eigen::Vector2d(0.02, -0.03)).norm(), 2e-3);
}

TEST_F(GroundEstimatorTest, MovesFeetWithTheGroundAndLeavesTheBase) {
  stand(standing({0, 1, 2, 3}), 1.0);
  const Eigen::VectorXd step = estimator_.correction(planned_), q = integrate(planned_, step);
  EXPECT_TRUE(step.head<6>().isZero(0.0));
  for (int foot = 0; foot < 4; ++foot) EXPECT_LT((position(q, foot) - moved(position(planned_, foot))).norm(), 2e-3);
}

/// What three feet know of the ground holds for the fourth.
TEST_F(GroundEstimatorTest, TellsAFootInTheAirWhereTheGroundIs) {
  stand_.in_contact[0] = false;
  stand(standing({1, 2, 3}), 1.0);
  const Eigen::Vector3d p = position(planned_, 0);
  EXPECT_LT((estimator_.displacement(p) - (moved(p) - p)).norm(), 2e-3);
}

/// It may be late, and hangs above the ground.
TEST_F(GroundEstimatorTest, DoesNotBelieveAFootThatHasJustLanded) {
  stand_.in_contact[0] = false;
  stand(planned_, 0.5);
  stand_.in_contact[0] = true;
  Eigen::VectorXd hanging = planned_;
  hanging(7 + 2) -= 0.2;
  stand(hanging, 0.04);
  EXPECT_LT(std::abs(estimator_.height()), 1e-9);
  stand(hanging, 0.5);
  EXPECT_GT(std::abs(estimator_.height()), 1e-4);
}

/// Else a foot that is late hovers while its leg pushes.
TEST_F(GroundEstimatorTest, AimsBelowTheGroundWhereAFootLands) {
  const auto height = [this](int foot) {
    return position(integrate(planned_, estimator_.correction(planned_)), foot).z() - position(planned_, foot).z();
  };
  Stand three = stand_;
  three.in_contact[3] = false;
  const auto advance = [&](const Stand& now, const Stand& soon, double seconds) {
    for (int i = 0; i * kStep < seconds; ++i) estimator_.update(kStep, planned_, planned_, now, soon);
  };
  advance(three, three, 0.2);
  EXPECT_LT(std::abs(height(3)), 1e-4);
  advance(three, stand_, GroundEstimator::kLead);
  const double below = height(3);
  EXPECT_LT(below, -0.005 * robot_.nominal_configuration().z());
  EXPECT_LT(std::abs(height(0)), 1e-4);
  advance(stand_, stand_, 0.04);
  EXPECT_NEAR(height(3), below, 1e-4);
  advance(stand_, stand_, 0.3);
  EXPECT_LT(std::abs(height(3)), 1e-4);
}

TEST_F(GroundEstimatorTest, LeavesContactsThatNeverStand) {
  GroundEstimator three(robot_, planned_, stand_, {true, true, true, false});
  const Eigen::VectorXd q = standing({0, 1, 2, 3});
  for (int i = 0; i < 500; ++i) three.update(kStep, q, planned_, stand_, stand_);
  const Eigen::VectorXd step = three.correction(planned_);
  EXPECT_TRUE(step.tail<3>().isZero(0.0)) << step.tail<3>();
  EXPECT_GT(step.segment<3>(6).norm(), 1e-3);
}

/// On a slope feet tell along its normal only: the base drifts, and feet slip.
TEST_F(GroundEstimatorTest, IgnoresWhatLiesAlongTheSurface) {
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.26, 0.0, 1.0).normalized();
  stand_.normals.assign(4, normal);
  Eigen::VectorXd q = planned_;
  q.head<3>() += 0.01 * Eigen::Vector3d(normal.z(), 0.0, -normal.x()) + 0.02 * Eigen::Vector3d::UnitY();
  stand(q, 0.5);
  EXPECT_LT(std::abs(estimator_.height()), 1e-9);
  EXPECT_LT(estimator_.tilt().norm(), 1e-9);
}

}  // namespace
}  // namespace prowl
