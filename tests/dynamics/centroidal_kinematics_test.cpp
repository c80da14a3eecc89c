#include "prowl/dynamics/centroidal_kinematics.hpp"

#include <gtest/gtest.h>

#include <pinocchio/algorithm/center-of-mass.hpp>
#include <pinocchio/algorithm/centroidal.hpp>
#include <pinocchio/multibody/data.hpp>

#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/pinocchio_model.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// r and A_G v as one vector.
VectorXd values(CentroidalKinematics& kinematics, const VectorXd& q, const VectorXd& v) {
  kinematics.update(q, v);
  VectorXd both(9);
  both << kinematics.com(), kinematics.momentum();
  return both;
}

/// d(r, A_G v)/dq and /dv, 9 x 2 nv.
MatrixXd slopes(CentroidalKinematics& kinematics, const VectorXd& q, const VectorXd& v) {
  kinematics.update(q, v);
  const Eigen::Index nv = v.size();
  MatrixXd both = MatrixXd::Zero(9, 2 * nv);
  both.topLeftCorner(3, nv) = kinematics.com_dq();
  both.bottomLeftCorner(6, nv) = kinematics.momentum_dq();
  both.bottomRightCorner(6, nv) = kinematics.momentum_dv();
  return both;
}

VectorXd unit(Eigen::Index size, Eigen::Index i) { return VectorXd::Unit(size, i); }

TEST(CentroidalKinematics, ComAndMomentumAreThoseOfPinocchio) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::talos()}) {
    CentroidalKinematics kinematics(robot);
    const pinocchio::Model& model = robot.pinocchio().model;
    pinocchio::Data data(model);
    test::RandomStates states(robot, 3);
    for (int i = 0; i < 20; ++i) {
      const VectorXd q = states.configuration(), v = states.velocity();
      pinocchio::ccrba(model, data, q, v);
      pinocchio::centerOfMass(model, data, q, v);
      kinematics.update(q, v);
      EXPECT_LT((kinematics.com() - data.com[0]).norm(), 1e-12);
      EXPECT_LT((kinematics.momentum().head<3>() / robot.mass() - data.vcom[0]).norm(), 1e-12);
      EXPECT_LT((kinematics.momentum() - data.hg.toVector()).norm(), 1e-11 * robot.mass());
      EXPECT_LT((kinematics.momentum_dv() - data.Ag).norm(), 1e-11 * robot.mass());
    }
  }
}

/// Whatever the joints do, nothing turns a robot in the air, and its centre of mass falls.
TEST(CentroidalKinematics, MomentumStaysInTheAir) {
  for (const RobotModel& robot : {test::hyq(), test::solo12(), test::talos()}) {
    test::RandomStates states(robot, 4);
    const VectorXd q = states.configuration(), v = states.velocity();
    std::mt19937 rng(5);
    ForwardDynamics dynamics(robot, {});
    dynamics.evaluate(q, v, test::random_vector(rng, robot.nu(), 0.1 * robot.weight()));
    CentroidalKinematics kinematics(robot);
    kinematics.update(q, v);
    VectorXd rate = v;  // in the tangent of q
    rate.head<3>() = base_rotation(q) * v.head<3>();
    const SpatialVector by_a = kinematics.momentum_dv() * dynamics.acceleration();
    SpatialVector expected = SpatialVector::Zero();
    expected(2) = -robot.weight();
    EXPECT_LT((kinematics.momentum_dq() * rate + by_a - expected).norm(), 1e-9 * by_a.norm()) << robot.name();
  }
}

TEST(CentroidalKinematics, FirstDerivativesAreThoseOfDifferences) {
  const RobotModel robot = test::hyq();
  CentroidalKinematics kinematics(robot);
  test::RandomStates states(robot, 4);
  const VectorXd q = states.configuration(), v = states.velocity();
  const MatrixXd slope = slopes(kinematics, q, v);
  constexpr double kStep = 1e-5;
  for (Eigen::Index i = 0; i < robot.nv(); ++i) {
    const VectorXd step = kStep * unit(robot.nv(), i);
    const auto at = [&](const VectorXd& in_q, const VectorXd& in_v) {
      return values(kinematics, integrate(q, in_q), v + in_v);
    };
    const VectorXd none = VectorXd::Zero(robot.nv());
    const VectorXd in_q = (at(step, none) - at(-step, none)) / (2 * kStep);
    const VectorXd in_v = (at(none, step) - at(none, -step)) / (2 * kStep);
    EXPECT_LT((slope.col(i) - in_q).norm(), 1e-7 * robot.mass()) << i;
    EXPECT_LT((slope.col(robot.nv() + i) - in_v).norm(), 1e-7 * robot.mass()) << i;
  }
}

/// The block of the base's rotation is the symmetric part of what differences of the gradient give, for rotations do
/// not commute.
TEST(CentroidalKinematics, SecondDerivativesAreThoseOfDifferences) {
  for (const RobotModel& robot : {test::hyq(), test::talos()}) {
    CentroidalKinematics kinematics(robot);
    test::RandomStates states(robot, 5);
    const VectorXd q = states.configuration(), v = states.velocity();
    std::mt19937 rng(6);
    const VectorXd lambda = test::random_vector(rng, 9, 1.0);
    const Eigen::Index nv = robot.nv();
    MatrixXd qq = MatrixXd::Zero(nv, nv), qv = qq, qq_difference = qq, qv_difference = qq;
    kinematics.update(q, v);
    kinematics.add_hessian(lambda.head<3>(), lambda.tail<6>(), qq, qv);
    constexpr double kStep = 1e-5;
    for (Eigen::Index i = 0; i < nv; ++i) {
      const VectorXd step = kStep * unit(nv, i);
      const MatrixXd change = slopes(kinematics, integrate(q, step), v) - slopes(kinematics, integrate(q, -step), v);
      const VectorXd bend = change.transpose() * lambda / (2 * kStep);
      qq_difference.row(i) = bend.head(nv).transpose();
      qv_difference.row(i) = bend.tail(nv).transpose();
    }
    qq_difference = (0.5 * (qq_difference + qq_difference.transpose())).eval();
    EXPECT_LT((qq - qq_difference).norm(), 1e-7 * robot.mass()) << robot.name();
    EXPECT_LT((qv - qv_difference).norm(), 1e-7 * robot.mass()) << robot.name();
    EXPECT_GT(qq.norm(), 1.0);
    EXPECT_GT(qv.norm(), 1.0);
  }
}

}  // namespace
}  // namespace prowl
