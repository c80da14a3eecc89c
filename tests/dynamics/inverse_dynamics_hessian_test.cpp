#include "prowl/dynamics/inverse_dynamics_hessian.hpp"

#include <gtest/gtest.h>

#include <pinocchio/algorithm/rnea-second-order-derivatives.hpp>
#include <pinocchio/multibody/data.hpp>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/pinocchio_model.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

/// The same from Pinocchio's tensors, contracted afterwards.
SecondDerivatives by_tensors(const RobotModel& robot, const DynamicsPoint& point, const Eigen::VectorXd& lambda) {
  const int nv = robot.nv();
  const pinocchio::Model& model = robot.pinocchio().model;
  pinocchio::Data data(model);
  pinocchio::ComputeRNEASecondOrderDerivatives(model, data, point.q, point.v, point.a);
  // Tensors are (row of r0, first index, second index), row fastest: one product contracts the rows.
  const auto contract = [&](const auto& tensor) -> Eigen::MatrixXd {
    const Eigen::Map<const Eigen::MatrixXd> flat(tensor.data(), nv, nv * nv);
    const Eigen::RowVectorXd contracted = lambda.transpose() * flat;
    return Eigen::Map<const Eigen::MatrixXd>(contracted.data(), nv, nv);
  };
  SecondDerivatives result(nv);
  result.qq = contract(data.d2tau_dqdq);
  result.qv = contract(data.d2tau_dqdv);
  result.vv = contract(data.d2tau_dvdv);
  result.qa = contract(data.d2tau_dadq).transpose();
  // Inverse dynamics do not depend on the place of the base, and the Hessian is the symmetric part.
  result.qq.topRows<3>().setZero();
  result.qq.leftCols<3>().setZero();
  result.qv.topRows<3>().setZero();
  result.qa.topRows<3>().setZero();
  result.qq = (0.5 * (result.qq + result.qq.transpose())).eval();
  result.vv = (0.5 * (result.vv + result.vv.transpose())).eval();
  return result;
}

TEST(InverseDynamicsHessian, IsPinocchiosTensorsContracted) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::talos()}) {
    std::mt19937 rng(5);
    RigidBodyTerms terms(robot);
    for (int i = 0; i < 20; ++i) {
      const DynamicsPoint point = test::random_point(robot, {}, rng);
      const Eigen::VectorXd lambda = test::random_vector(rng, robot.nv(), 1.0);
      const SecondDerivatives expected = by_tensors(robot, point, lambda);
      SecondDerivatives actual(robot.nv());
      terms.update_with_derivatives(point.q, point.v, point.a);
      terms.add_second_derivatives(lambda, actual);
      EXPECT_LT(test::relative_error(actual.qq, expected.qq), 1e-9) << robot.name();
      EXPECT_LT(test::relative_error(actual.qv, expected.qv), 1e-9) << robot.name();
      EXPECT_LT(test::relative_error(actual.vv, expected.vv), 1e-9) << robot.name();
      EXPECT_LT(test::relative_error(actual.qa, expected.qa), 1e-9) << robot.name();
    }
  }
}

TEST(InverseDynamicsHessian, AddsToWhatIsThere) {
  const RobotModel robot = test::hyq();
  std::mt19937 rng(6);
  RigidBodyTerms terms(robot);
  const DynamicsPoint point = test::random_point(robot, {}, rng);
  terms.update_with_derivatives(point.q, point.v, point.a);
  const Eigen::VectorXd lambda = test::random_vector(rng, robot.nv(), 1.0);
  SecondDerivatives once(robot.nv()), twice(robot.nv());
  terms.add_second_derivatives(lambda, once);
  terms.add_second_derivatives(lambda, twice);
  terms.add_second_derivatives(lambda, twice);
  EXPECT_GT(once.qq.norm(), 0.0);
  EXPECT_LT(test::relative_error(twice.qq, 2.0 * once.qq), 1e-14);
  EXPECT_LT(test::relative_error(twice.qv, 2.0 * once.qv), 1e-14);
  EXPECT_LT(test::relative_error(twice.vv, 2.0 * once.vv), 1e-14);
  EXPECT_LT(test::relative_error(twice.qa, 2.0 * once.qa), 1e-14);
}

}  // namespace
}  // namespace prowl
