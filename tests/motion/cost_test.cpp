#include "prowl/motion/cost.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

TEST(ConfigurationCost, DerivativesAreThoseOfDifferences) {
  const RobotModel robot = test::hyq();
  std::mt19937 rng(2);
  const Eigen::Index nv = robot.nv();
  const double step = 1e-3;
  for (const double turn : {0.0, 0.3, 2.5}) {
    Eigen::VectorXd tangent = test::random_vector(rng, nv, 0.5);
    tangent.segment<3>(3) = turn * Eigen::Vector3d(1.0, -2.0, 2.0) / 3.0;
    const Eigen::VectorXd q_ref = robot.nominal_configuration(), q = integrate(q_ref, tangent);
    const Eigen::VectorXd weight = Eigen::VectorXd::LinSpaced(nv, 1.0, 5.0);
    const ConfigurationCost cost = configuration_cost(q_ref, weight, q);
    const auto value = [&](const Eigen::VectorXd& d) {
      return configuration_cost(q_ref, weight, integrate(q, d)).value;
    };
    const auto unit = [&](Eigen::Index i) -> Eigen::VectorXd { return step * Eigen::VectorXd::Unit(nv, i); };

    Eigen::MatrixXd hessian = cost.hessian_diagonal.asDiagonal();
    hessian.block<3, 3>(3, 3) = cost.hessian_rotation;
    Eigen::VectorXd gradient(nv);
    Eigen::MatrixXd second(nv, nv);
    for (Eigen::Index i = 0; i < nv; ++i) {
      gradient(i) = (8 * (value(unit(i)) - value(-unit(i))) - (value(2 * unit(i)) - value(-2 * unit(i)))) / (12 * step);
      for (Eigen::Index j = 0; j < nv; ++j) {
        const Eigen::VectorXd s = unit(i) + unit(j), d = unit(i) - unit(j);
        second(i, j) = (value(s) - value(d) - value(-d) + value(-s)) / (4 * step * step);
      }
    }
    EXPECT_LT(test::relative_error(cost.gradient, gradient), 1e-8) << turn;
    EXPECT_LT(test::relative_error(hessian, second), 1e-5) << turn;
  }
}

}  // namespace
}  // namespace prowl
