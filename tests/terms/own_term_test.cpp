#include "prowl/terms/own_term.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "prowl/error.hpp"
#include "prowl/terms/term_derivatives.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Kind = Quantity::Kind;

/// Every function that a user may call, with numbers and vectors of double beside the scalar.
std::shared_ptr<const Term> many_functions() {
  const Vector3d center(0.1, -0.2, 0.3);
  return own_term<6, 5>({{.kind = Kind::position, .name = "lf_foot"}, {.kind = Kind::velocity, .name = "lf_foot"}},
                        {"distance", "angle", "power", "mixed", "constant"}, "-", [center](const auto& y, auto& f) {
                          using Scalar = typename std::decay_t<decltype(f)>::Scalar;
                          using std::abs, std::atan, std::atan2, std::exp, std::log, std::pow, std::sin, std::sqrt;
                          const auto position = y.template head<3>();
                          const auto velocity = y.template tail<3>();
                          f(0) = (position - center).norm() - 0.5 + 2.0 * (center - position).squaredNorm();
                          f(1) = atan2(y(0), 2.0 + y(1) * y(1)) + atan(y(2)) * 3.0 + sin(y(3));
                          f(2) = pow(1.0 + y(0) * y(0), 2.5) + abs(y(4) - 3.0) * pow(y(5), 3);
                          f(3) = position.dot(velocity) / (1.0 + exp(y(1))) + log(2.0 + sqrt(1.0 + y(3) * y(3))) +
                                 position.cross(velocity)(1);
                          f(4) = Scalar(7.0);
                        });
}

TEST(OwnTerm, DerivativesAreThoseOfDifferences) {
  const RobotModel robot = test::hyq();
  std::mt19937 rng(3);
  for (int sample = 0; sample < 10; ++sample) {
    EXPECT_EQ(wrong_derivative(robot, *many_functions(), test::random_vector(rng, 6, 1.0)), "");
  }
}

TEST(OwnTerm, HasTheValueOfItsFunction) {
  VectorXd y(6), f(5);
  y << 0.1, -0.2, 1.3, 0.0, 3.0, 2.0;
  many_functions()->value(y, f);
  EXPECT_DOUBLE_EQ(f(0), 0.5 + 2.0);
  EXPECT_DOUBLE_EQ(f(4), 7.0);
}

TEST(OwnTerm, RefusesTheWrongNumberOfRowsOrEntries) {
  const auto same = [](const auto& y, auto& f) { f = y; };
  EXPECT_THROW((own_term<3, 3>({{.kind = Kind::center_of_mass}}, {"x", "y"}, "m", same)), InputError);
  const auto term = own_term<3, 3>({{.kind = Kind::center_of_mass}}, {"x", "y", "z"}, "m", same);
  VectorXd f(3);
  MatrixXd f_y(3, 9);
  EXPECT_THROW(term->value(VectorXd::Zero(9), f), InputError);
  EXPECT_THROW(term->jacobian(VectorXd::Zero(9), f_y), InputError);
}

}  // namespace
}  // namespace prowl
