#include "prowl/dynamics/projected_residual.hpp"

#include <gtest/gtest.h>

#include "prowl/error.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using test::Argument;
constexpr Argument kArguments[] = {Argument::q, Argument::v, Argument::a, Argument::tau, Argument::w, Argument::anchor};
/// The residual is linear in all but q and v, where a long step only helps against rounding.
double step_of(Argument argument) { return argument == Argument::q || argument == Argument::v ? 1e-5 : 1.0; }
constexpr double kStep = 1e-5;

struct Case {
  const char* name;
  RobotModel robot;
  std::vector<int> contacts;
  std::vector<int> chosen_rows = {};

  ProjectedResidual dynamics() const { return {robot, contacts, chosen_rows}; }
  DynamicsPoint random_point(std::mt19937& rng) const {
    return test::random_point(robot, contacts, rng, chosen_rows.size());
  }
};

/// Two flat feet with four points each: of a foot, three points that hold 3, 2 and 1 rows are independent.
Case talos_with_chosen_rows() {
  return {"talos, chosen rows", test::talos(), {0, 1, 2, 3, 4, 5, 6, 7}, {5, 6, 7, 8, 9, 10, 17, 18, 19, 20, 21, 22}};
}

std::vector<Case> cases() {
  std::vector<Case> result;
  for (const auto& [name, contacts] : {std::pair<const char*, std::vector<int>>{"four", {0, 1, 2, 3}},
                                       {"three", {0, 1, 3}},
                                       {"diagonal", {0, 3}},
                                       {"one", {2}},
                                       {"none", {}}}) {
    result.push_back({name, test::hyq(), contacts});
  }
  result.push_back({"anymal", test::anymal_c(), {0, 1, 2, 3}});
  result.push_back({"solo12", test::solo12(), {0, 3}});
  result.push_back({"go2", test::go2(), {0, 1, 2, 3}});
  return result;
}

Eigen::MatrixXd block(const PointDerivatives& d, Argument argument, double kp) {
  switch (argument) {
    case Argument::v: return d.v;
    case Argument::a: return d.a;
    case Argument::tau: return d.tau;
    case Argument::w: return d.w;
    case Argument::anchor: return -kp * d.e;
    default: return d.q;
  }
}

/// Central differences of residual and forces in one argument.
PointDerivatives differences(ProjectedResidual& dynamics, const DynamicsPoint& point, Argument argument,
                             Eigen::Index size) {
  PointDerivatives result;  // .q of residual, .v of forces: two matrices are all that is needed
  const double step = step_of(argument);
  for (Eigen::Index i = 0; i < size; ++i) {
    dynamics.evaluate(test::moved(point, argument, i, step));
    const Eigen::VectorXd c = dynamics.residual(), f = dynamics.forces();
    dynamics.evaluate(test::moved(point, argument, i, -step));
    result.q.conservativeResize(c.size(), size);
    result.v.conservativeResize(f.size(), size);
    result.q.col(i) = (c - dynamics.residual()) / (2.0 * step);
    result.v.col(i) = (f - dynamics.forces()) / (2.0 * step);
  }
  return result;
}

void expect_first_derivatives(const Case& test, int points) {
  std::mt19937 rng(7);
  ProjectedResidual dynamics = test.dynamics(), varied = test.dynamics();
  double residual_size = 0.0;
  for (int i = 0; i < points; ++i) {
    const DynamicsPoint point = test.random_point(rng);
    dynamics.evaluate_with_derivatives(point);
    residual_size = std::max(residual_size, dynamics.residual().norm());
    for (const Argument argument : kArguments) {
      const PointDerivatives expected = differences(varied, point, argument, test::size_of(point, argument));
      const double kp = point.stabilisation.kp;
      EXPECT_LT(test::relative_error(block(dynamics.residual_derivatives(), argument, kp), expected.q, 1.0), 1e-6)
          << test.name << ", residual, argument " << static_cast<int>(argument);
      EXPECT_LT(test::relative_error(block(dynamics.force_derivatives(), argument, kp), expected.v), 1e-6)
          << test.name << ", forces, argument " << static_cast<int>(argument);
    }
  }
  EXPECT_GT(residual_size, 1.0) << "the points are to be away from c = 0";
}

TEST(ProjectedResidual, FirstDerivativesAreThoseOfDifferences) {
  for (const Case& test : cases()) expect_first_derivatives(test, 10);
}

TEST(ProjectedResidual, FirstDerivativesHoldForRedundantContacts) {
  const RobotModel talos = test::talos();
  expect_first_derivatives({"talos", talos, {0, 1, 2, 3, 4, 5, 6, 7}}, 2);
  ProjectedResidual dynamics(talos, {0, 1, 2, 3, 4, 5, 6, 7});
  std::mt19937 rng(3);
  dynamics.evaluate(test::random_point(talos, dynamics.contacts(), rng));
  EXPECT_EQ(dynamics.rank(), 12);
}

TEST(ProjectedResidual, FirstDerivativesHoldForChosenForces) { expect_first_derivatives(talos_with_chosen_rows(), 2); }

TEST(ProjectedResidual, ChosenForcesReachTheForcesOfLeastNorm) {
  const Case talos = talos_with_chosen_rows();
  ProjectedResidual least(talos.robot, talos.contacts), chosen = talos.dynamics();
  std::mt19937 rng(31);
  for (int i = 0; i < 20; ++i) {
    // Feet that stand: their points agree, so that no row of e is lost.
    DynamicsPoint point = talos.random_point(rng);
    point.v.setZero();
    least.evaluate(point);
    point.anchors = least.kinematics().positions();
    least.evaluate(point);
    point.chosen_forces = least.forces()(talos.chosen_rows);
    chosen.evaluate(point);
    EXPECT_TRUE(chosen.has_full_rank());
    EXPECT_FALSE(least.has_full_rank());
    EXPECT_EQ(chosen.rank(), 12);
    EXPECT_LT(test::relative_error(chosen.forces(), least.forces()), 1e-10);
    EXPECT_LT(test::relative_error(chosen.residual(), least.residual()), 1e-10);
    // Other choices give other forces that do the same to the robot.
    point.chosen_forces *= 0.5;
    chosen.evaluate(point);
    EXPECT_LT(test::relative_error(chosen.residual(), least.residual()), 1e-10);
    EXPECT_GT(test::relative_error(chosen.forces(), least.forces()), 1e-3);
  }
}

TEST(ProjectedResidual, VanishesExactlyOnTheProjectedEquationsAndTheContactCondition) {
  const RobotModel robot = test::hyq();
  const std::vector<int> contacts{0, 1, 2, 3};
  ProjectedResidual dynamics(robot, contacts);
  EXPECT_GT(dynamics.contact_weight(), 1e-3 * robot.mass())
      << "contacts would hold to no more than 1e-2 m/s^2 at tolerance 1e-6";
  std::mt19937 rng(11);
  for (int i = 0; i < 20; ++i) {
    const DynamicsPoint point = test::random_point(robot, contacts, rng);
    dynamics.evaluate(point);
    // c = P r + s J+ e, so J c = s e at full rank: neither part can hide the other.
    const ContactKinematics& kinematics = dynamics.kinematics();
    const Eigen::VectorXd e =
        kinematics.acceleration() + point.stabilisation.kp * (kinematics.positions() - point.anchors);
    EXPECT_LT(test::relative_error(kinematics.jacobian() * dynamics.residual(), dynamics.contact_weight() * e), 1e-10);
    // P c = P r, with P made from the null space and r from the definition.
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(kinematics.jacobian());
    const Eigen::MatrixXd kernel = lu.kernel();
    Eigen::VectorXd r = dynamics.residual() + kinematics.jacobian().transpose() * dynamics.forces();
    Eigen::VectorXd expected = dynamics.terms().inverse_dynamics();
    expected.tail(point.tau.size()) -= point.tau;
    EXPECT_LT(test::relative_error(r, expected), 1e-10);
    EXPECT_LT(test::relative_error(kernel.transpose() * dynamics.residual(), kernel.transpose() * expected), 1e-10);
  }
}

TEST(ProjectedResidual, HessianIsThatOfDifferencesOfTheGradient) {
  std::vector<Case> all = cases();
  all.push_back(talos_with_chosen_rows());
  for (const Case& test : all) {
    std::mt19937 rng(23);
    ProjectedResidual dynamics = test.dynamics();
    const Eigen::Index nv = test.robot.nv();
    const bool is_large = nv > 18;
    for (int i = 0; i < (is_large ? 1 : 3); ++i) {
      const DynamicsPoint point = test.random_point(rng);
      const double kp = point.stabilisation.kp;
      const Eigen::VectorXd mu = test::random_vector(rng, nv, 1.0);
      const Eigen::VectorXd nu = test::random_vector(rng, point.anchors.size(), 1.0);
      const auto gradient = [&](const DynamicsPoint& at, Argument argument) -> Eigen::VectorXd {
        dynamics.evaluate_with_derivatives(at);
        return block(dynamics.residual_derivatives(), argument, kp).transpose() * mu +
               block(dynamics.force_derivatives(), argument, kp).transpose() * nu;
      };
      // d/dq of the gradient in v, a, tau gives the mixed blocks without the tangent of q getting in the way; d/dv the
      // block vv. The block qq needs the value: the gradient itself lives in a tangent that moves.
      Eigen::MatrixXd vq(nv, nv), aq(nv, nv), tauq(test.robot.nu(), nv), vv(nv, nv);
      Eigen::MatrixXd wq(point.chosen_forces.size(), nv), anchorq(point.anchors.size(), nv);
      for (Eigen::Index j = 0; j < nv; ++j) {
        const DynamicsPoint plus = test::moved(point, Argument::q, j, kStep);
        const DynamicsPoint minus = test::moved(point, Argument::q, j, -kStep);
        vq.col(j) = (gradient(plus, Argument::v) - gradient(minus, Argument::v)) / (2 * kStep);
        aq.col(j) = (gradient(plus, Argument::a) - gradient(minus, Argument::a)) / (2 * kStep);
        tauq.col(j) = (gradient(plus, Argument::tau) - gradient(minus, Argument::tau)) / (2 * kStep);
        wq.col(j) = (gradient(plus, Argument::w) - gradient(minus, Argument::w)) / (2 * kStep);
        anchorq.col(j) = (gradient(plus, Argument::anchor) - gradient(minus, Argument::anchor)) / (2 * kStep);
        vv.col(j) = (gradient(test::moved(point, Argument::v, j, kStep), Argument::v) -
                     gradient(test::moved(point, Argument::v, j, -kStep), Argument::v)) /
                    (2 * kStep);
      }
      const auto value = [&](const Eigen::VectorXd& tangent) {
        DynamicsPoint at = point;
        at.q = integrate(point.q, tangent);
        dynamics.evaluate(at);
        return mu.dot(dynamics.residual()) + nu.dot(dynamics.forces());
      };
      const double step = 1e-3;
      Eigen::MatrixXd qq(nv, nv);
      const auto unit = [&](Eigen::Index index) -> Eigen::VectorXd { return step * Eigen::VectorXd::Unit(nv, index); };
      for (Eigen::Index j = 0; j < nv; ++j) {
        for (Eigen::Index k = 0; k <= j; ++k) {
          const Eigen::VectorXd s = unit(j) + unit(k), d = unit(j) - unit(k);
          // Two steps, Richardson: fourth order, so that 1e-6 can be asked of a second difference.
          const auto second = [&](double scale) {
            return (value(scale * s) - value(scale * d) - value(-scale * d) + value(-scale * s)) /
                   (4.0 * step * step * scale * scale);
          };
          qq(j, k) = qq(k, j) = (4.0 * second(1.0) - second(2.0)) / 3.0;
        }
      }
      dynamics.evaluate_with_derivatives(point);
      const PointHessian& hessian = dynamics.hessian(point, mu, nu);
      EXPECT_LT(test::relative_error(hessian.qv, vq.transpose()), 1e-6) << test.name;
      EXPECT_LT(test::relative_error(hessian.qa, aq.transpose()), 1e-6) << test.name;
      EXPECT_LT(test::relative_error(hessian.qtau, tauq.transpose()), 1e-6) << test.name;
      EXPECT_LT(test::relative_error(hessian.qw, wq.transpose()), 1e-6) << test.name;
      EXPECT_LT(test::relative_error(-kp * hessian.qe, anchorq.transpose()), 1e-6) << test.name;
      EXPECT_LT(test::relative_error(hessian.vv, vv), 1e-6) << test.name;
      EXPECT_LT(test::relative_error(hessian.qq, qq), 1e-5) << test.name;
    }
  }
}

TEST(ProjectedResidual, RefusesNumbersThatAreNotFinite) {
  const RobotModel robot = test::hyq();
  ProjectedResidual dynamics(robot, {0, 1, 2, 3});
  std::mt19937 rng(1);
  DynamicsPoint point = test::random_point(robot, dynamics.contacts(), rng);
  point.v(7) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(dynamics.evaluate(point), NumericalError);
}

}  // namespace
}  // namespace prowl
