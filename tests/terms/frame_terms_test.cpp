#include "prowl/terms/frame_terms.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "prowl/error.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/terms/selected_entries.hpp"
#include "prowl/terms/torque_peaks.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Matrix3d random_rotation(std::mt19937& rng, double angle) {
  return so3::exp(angle * test::random_vector(rng, 3, 1.0).normalized());
}

/// The entries that a term reads, of frames turned by at most `angle`, and not quite orthonormal: as functions of
/// independent entries terms must have the right derivatives there, too.
VectorXd random_reading(const RobotModel& robot, const Term& term, std::mt19937& rng, double angle) {
  VectorXd y = test::random_vector(rng, size_of(term.reads(), robot), 1.0);
  Eigen::Index first = 0;
  for (const Quantity& quantity : term.reads()) {
    const int size = size_of(quantity.kind, robot);
    if (quantity.kind == Quantity::Kind::orientation) {
      y.segment(first, size) = Matrix3d(random_rotation(rng, angle) + test::random_matrix(rng, 3, 3, 0.01)).reshaped();
    }
    first += size;
  }
  return y;
}

std::vector<std::shared_ptr<const Term>> all_terms(const RobotModel& robot, const Matrix3d& reference) {
  return {frame_position("hand"),
          frame_position("hand", "base"),
          frame_orientation("hand", reference),
          frame_orientation("hand", reference, "base"),
          frame_velocity("hand"),
          frame_angular_velocity("hand"),
          frame_pointing_along("hand", {0.0, 0.0, 2.0}, {0.1, 0.2, 3.0}),
          frame_pointing_at("hand", {1.0, 0.5, 0.2}, {4.0, 1.0, 2.0}),
          center_of_mass(),
          center_of_mass_velocity(),
          angular_momentum(),
          joint_positions(robot, {3, 1}),
          joint_rates(robot, {0}),
          joint_torques(robot, {2, 0}),
          contact_force("rf_foot"),
          torque_peaks(robot)};
}

TEST(FrameTerms, DerivativesAreThoseOfDifferences) {
  const RobotModel robot = test::hyq();
  std::mt19937 rng(3);
  for (int sample = 0; sample < 20; ++sample) {
    for (const auto& term : all_terms(robot, random_rotation(rng, 0.5))) {
      const VectorXd y = random_reading(robot, *term, rng, sample == 0 ? 1e-3 : 1.0);
      const VectorXd multipliers = test::random_vector(rng, term->num_rows(), 1.0);
      const auto value = [&](const VectorXd& at) {
        VectorXd f(term->num_rows());
        term->value(at, f);
        return f;
      };
      const auto jacobian = [&](const VectorXd& at) {
        MatrixXd f_y = MatrixXd::Zero(term->num_rows(), y.size());
        term->jacobian(at, f_y);
        return f_y;
      };
      MatrixXd by_differences(term->num_rows(), y.size()), second(y.size(), y.size()),
          hessian = MatrixXd::Zero(y.size(), y.size());
      for (Eigen::Index i = 0; i < y.size(); ++i) {
        const VectorXd step = 1e-6 * VectorXd::Unit(y.size(), i);
        by_differences.col(i) = (value(y + step) - value(y - step)) / 2e-6;
        second.col(i) = (jacobian(y + step) - jacobian(y - step)).transpose() * multipliers / 2e-6;
      }
      term->hessian(y, multipliers, hessian);
      EXPECT_LT(test::relative_error(jacobian(y), by_differences, 1.0), 1e-7) << term->reads()[0].name;
      EXPECT_LT(test::relative_error(hessian, second, 1.0), 1e-7) << term->num_rows() << " rows in " << term->unit();
    }
  }
}

TEST(FrameTerms, OrientationIsTheRotationVectorFromTheReference) {
  std::mt19937 rng(4);
  for (const double angle : {0.0, 1e-5, 0.1, 1.0, 3.0}) {
    const Matrix3d reference = random_rotation(rng, 2.0), other = random_rotation(rng, 2.0);
    const Vector3d off = angle * test::random_vector(rng, 3, 1.0).normalized();
    VectorXd y(18), f(3);
    y << Matrix3d(other * reference * so3::exp(off)).reshaped(), other.reshaped();
    frame_orientation("hand", reference, "base")->value(y, f);
    EXPECT_LT((f - off).norm(), 1e-10) << angle;
  }
}

TEST(FrameTerms, PointingIsTheAngleFromTheDirection) {
  std::mt19937 rng(5);
  for (const double angle : {0.0, 1e-5, 0.1, 1.0, 3.0}) {
    const Vector3d axis = test::random_vector(rng, 3, 1.0).normalized();
    const Vector3d across = axis.cross(Vector3d(test::random_vector(rng, 3, 1.0))).normalized();
    const Matrix3d R = random_rotation(rng, 2.0);
    const Vector3d direction = R * so3::exp(angle * across) * axis;
    VectorXd y(12), f(2);
    y << R.reshaped(), test::random_vector(rng, 3, 1.0);
    frame_pointing_along("camera", axis, direction)->value(y.head(9), f);
    EXPECT_NEAR(f.norm(), angle, 1e-10);
    frame_pointing_at("camera", axis, y.tail<3>() + 7.0 * direction)->value(y, f);
    EXPECT_NEAR(f.norm(), angle, 1e-10);
  }
}

TEST(FrameTerms, RefuseWhatNoMotionCanMeet) {
  const RobotModel robot = test::hyq();
  EXPECT_THROW(frame_orientation("hand", 2.0 * Matrix3d::Identity()), InputError);
  EXPECT_THROW(frame_orientation("hand", -Matrix3d::Identity()), InputError);
  EXPECT_THROW(frame_pointing_along("hand", Vector3d::Zero(), Vector3d::UnitX()), InputError);
  EXPECT_THROW(frame_pointing_along("hand", Vector3d::UnitX(), Vector3d::Zero()), InputError);
  EXPECT_THROW(frame_pointing_at("hand", Vector3d::UnitX(), Vector3d::Constant(std::nan(""))), InputError);
  EXPECT_THROW(joint_positions(robot, {robot.nu()}), InputError);
  EXPECT_THROW(joint_rates(robot, {-1}), InputError);
}

}  // namespace
}  // namespace prowl
