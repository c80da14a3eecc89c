#include "prowl/dynamics/forward_dynamics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <functional>
#include <limits>

#include "prowl/error.hpp"
#include "tests/support/null_space_dynamics.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::NullSpaceDynamics;
using test::RandomStates;

constexpr int kStates = 10000;
constexpr double kRegular = 1e-3;  // smallest to largest singular value of J

struct Sample {
  VectorXd q, v, tau;
};

/// A state that the contacts allow (J v = 0), away from singular postures; leaves `reference` at its configuration.
Sample sample_on_contacts(RandomStates& random, NullSpaceDynamics& reference) {
  Sample s;
  do {
    s.q = random.configuration();
    reference.set_configuration(s.q);
  } while (reference.singular_value_ratio < kRegular);
  s.v = reference.N * (reference.N.transpose() * random.velocity());
  s.tau = random.torque();
  return s;
}

struct WorstErrors {
  double acceleration = 0.0;  ///< relative to the reference's
  double contact = 0.0;       ///< |J a + J̇ v| / (|J| |a|)
  double force = 0.0;         ///< of minimum norm, relative
  double v = 0.0;             ///< smallest |v| seen, to know that velocities are there
};

WorstErrors compare(const RobotModel& robot, const std::vector<int>& contacts, int states, double window) {
  ForwardDynamics dynamics(robot, contacts);
  NullSpaceDynamics reference(robot, contacts);
  RandomStates random(robot, 1, window);
  WorstErrors worst;
  worst.v = std::numeric_limits<double>::infinity();
  for (int i = 0; i < states; ++i) {
    const Sample s = sample_on_contacts(random, reference);
    const VectorXd expected = reference.solve(s.v, s.tau);
    dynamics.evaluate(s.q, s.v, s.tau);
    const VectorXd& a = dynamics.acceleration();
    EXPECT_EQ(dynamics.projector().rank(), reference.rank);
    worst.acceleration = std::max(worst.acceleration, (a - expected).norm() / expected.norm());
    worst.v = std::min(worst.v, s.v.norm());
    if (contacts.empty()) continue;
    const double violation = (reference.J * a + reference.J_dot_v).norm();
    worst.contact = std::max(worst.contact, violation / (reference.J_norm * a.norm()));
    const VectorXd f = reference.pseudo_inverse.transpose() * (reference.M * expected - reference.applied);
    worst.force = std::max(worst.force, (dynamics.forces() - f).norm() / f.norm());
  }
  fmt::print("{}, contacts {}: acceleration {:.1e}, |Ja + J'v| / |J||a| {:.1e}, force {:.1e}\n", robot.name(),
             fmt::join(contacts, " "), worst.acceleration, worst.contact, worst.force);
  return worst;
}

struct Quadruped {
  const char* name;
  std::function<RobotModel()> load;
  std::vector<std::vector<int>> contact_sets;  ///< 4, 3, 2 diagonal, 2 hind, 1, 0 feet
};

void PrintTo(const Quadruped& quadruped, std::ostream* stream) { *stream << quadruped.name; }

class ForwardDynamicsOfQuadruped : public testing::TestWithParam<Quadruped> {};

// The gates: accelerations 1e-11, contacts and forces 1e-9; measured, a hundred times better (docs/theory.md#figures).
TEST_P(ForwardDynamicsOfQuadruped, AgreesWithANullSpaceSolve) {
  const RobotModel robot = GetParam().load();
  for (const std::vector<int>& contacts : GetParam().contact_sets) {
    const WorstErrors worst = compare(robot, contacts, kStates, std::numbers::pi);
    EXPECT_LT(worst.acceleration, 1e-11);
    EXPECT_LT(worst.contact, 1e-9);
    EXPECT_LT(worst.force, 1e-9);
    EXPECT_GT(worst.v, 0.01);
  }
}

const std::vector<std::vector<int>> kLeftSideFirst = {{0, 1, 2, 3}, {0, 1, 2}, {0, 3}, {1, 3}, {0}, {}};  // LF LH RF RH
const std::vector<std::vector<int>> kFrontFirst = {{0, 1, 2, 3}, {0, 1, 2}, {0, 3}, {2, 3}, {0}, {}};     // FL FR HL HR

INSTANTIATE_TEST_SUITE_P(All, ForwardDynamicsOfQuadruped,
                         testing::Values(Quadruped{"HyQ", test::hyq, kLeftSideFirst},
                                         Quadruped{"ANYmalC", test::anymal_c, kLeftSideFirst},
                                         Quadruped{"Solo12", test::solo12, kFrontFirst},
                                         Quadruped{"Go2", test::go2, kFrontFirst}),
                         testing::PrintToStringParamName());

const std::vector<int> kFourFeetTwice = {0, 1, 2, 3, 0, 1, 2, 3};
const std::vector<int> kBothSoles = {0, 1, 2, 3, 4, 5, 6, 7};

TEST(ForwardDynamics, TakesRedundantContacts) {
  const WorstErrors hyq = compare(test::hyq(), kFourFeetTwice, 2000, std::numbers::pi);
  const WorstErrors talos = compare(test::talos(), kBothSoles, 2000, 0.5);  // about standing on both feet
  for (const WorstErrors& worst : {hyq, talos}) {
    EXPECT_LT(worst.acceleration, 1e-11);
    EXPECT_LT(worst.contact, 1e-9);
    EXPECT_LT(worst.force, 1e-9);  // the reference's is the one of minimum norm
  }
}

TEST(ForwardDynamics, SharesForcesEquallyBetweenEqualContacts) {
  const RobotModel robot = test::hyq();
  ForwardDynamics once(robot, {0, 1, 2, 3}), twice(robot, kFourFeetTwice);
  NullSpaceDynamics reference(robot, {0, 1, 2, 3});
  RandomStates random(robot, 2);
  const Sample s = sample_on_contacts(random, reference);
  once.evaluate(s.q, s.v, s.tau);
  twice.evaluate(s.q, s.v, s.tau);
  EXPECT_LT((twice.forces().head(12) - once.forces() / 2.0).norm(), 1e-9 * once.forces().norm());
  EXPECT_LT((twice.forces().tail(12) - once.forces() / 2.0).norm(), 1e-9 * once.forces().norm());
}

TEST(ForwardDynamics, FallsFreelyWithoutContacts) {
  const RobotModel robot = test::hyq();
  ForwardDynamics dynamics(robot, {});
  RandomStates random(robot, 3);
  const VectorXd q = random.configuration();
  dynamics.evaluate(q, VectorXd::Zero(robot.nv()), VectorXd::Zero(robot.nu()));
  VectorXd expected = VectorXd::Zero(robot.nv());
  expected.head<3>() = base_rotation(q).transpose() * Eigen::Vector3d(0.0, 0.0, -RobotModel::kGravity);
  EXPECT_LT((dynamics.acceleration() - expected).norm(), 1e-10);
  EXPECT_EQ(dynamics.forces().size(), 0);
}

// Pardo et al. 2016, contact forces: J' = Qc R, lambda = R^-1 Qc' (M a + h - S' tau).
TEST(ForwardDynamics, RecoversTheForcesOfTheQrFormulaAtFullRank) {
  const RobotModel robot = test::hyq();
  for (const std::vector<int>& contacts : {std::vector<int>{0, 1, 2, 3}, {0, 3}, {2}}) {
    ForwardDynamics dynamics(robot, contacts);
    NullSpaceDynamics reference(robot, contacts);
    RandomStates random(robot, 4);
    for (int i = 0; i < 200; ++i) {
      const Sample s = sample_on_contacts(random, reference);
      const VectorXd a = reference.solve(s.v, s.tau);
      const Eigen::HouseholderQR<MatrixXd> qr(reference.J.transpose());
      const auto rows = reference.J.rows();
      const MatrixXd Qc = qr.householderQ() * MatrixXd::Identity(robot.nv(), rows);
      const VectorXd lambda = qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>().solve(
          Qc.transpose() * (reference.M * a - reference.applied));
      dynamics.evaluate(s.q, s.v, s.tau);
      EXPECT_LT((dynamics.forces() - lambda).norm(), 1e-9 * lambda.norm());
    }
  }
}

// The equation as printed, a = Mc^-1 (S' tau - h + M C v), is not the dynamics: it lacks the P.
TEST(ForwardDynamics, IsNotTheEquationAsPrinted) {
  const RobotModel robot = test::hyq();
  NullSpaceDynamics reference(robot, {0, 1, 2, 3});
  RandomStates random(robot, 5);
  double smallest = std::numeric_limits<double>::infinity(), corrected = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Sample s = sample_on_contacts(random, reference);
    const VectorXd a = reference.solve(s.v, s.tau);
    const MatrixXd P = reference.N * reference.N.transpose();
    const MatrixXd PM = P * reference.M;
    const MatrixXd Mc = reference.M + PM - PM.transpose();
    const VectorXd MCv = -reference.M * (reference.pseudo_inverse * reference.J_dot_v);
    const VectorXd printed = Mc.lu().solve(reference.applied + MCv);
    const VectorXd with_P = Mc.lu().solve(P * reference.applied + MCv);
    smallest = std::min(smallest, (printed - a).norm() / a.norm());
    corrected = std::max(corrected, (with_P - a).norm() / a.norm());
  }
  fmt::print("equation as printed: at least {:.1e} off; with the P: at most {:.1e}\n", smallest, corrected);
  EXPECT_GT(smallest, 0.5) << "docs/paper.md: 0.59 at least";
  EXPECT_LT(corrected, 1e-10);
}

TEST(ForwardDynamics, RefusesWhatIsNotANumber) {
  const RobotModel robot = test::hyq();
  ForwardDynamics dynamics(robot, {0, 1, 2, 3});
  const VectorXd v = VectorXd::Zero(robot.nv()), tau = VectorXd::Zero(robot.nu());
  VectorXd q = robot.nominal_configuration();
  EXPECT_THROW(dynamics.evaluate(q, v, tau * std::numeric_limits<double>::quiet_NaN()), NumericalError);
  q(9) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(dynamics.evaluate(q, v, tau), NumericalError);
}

using Function = std::function<VectorXd(const VectorXd&)>;

/// Derivative of y at 0 by central differences of fourth order.
MatrixXd central_differences(const Function& y, Eigen::Index size, double step) {
  MatrixXd derivative(y(VectorXd::Zero(size)).size(), size);
  for (Eigen::Index j = 0; j < size; ++j) {
    const VectorXd d = step * VectorXd::Unit(size, j);
    derivative.col(j) = (8.0 * (y(d) - y(-d)) - (y(2.0 * d) - y(-2.0 * d))) / (12.0 * step);
  }
  return derivative;
}

/// Largest error of a column, relative to the column (to a thousandth of the largest, where it is smaller than that).
double worst_column(const MatrixXd& actual, const MatrixXd& expected) {
  if (expected.size() == 0) return 0.0;
  const Eigen::RowVectorXd scale = expected.colwise().norm();
  const Eigen::RowVectorXd errors = (actual - expected).colwise().norm();
  return errors.cwiseQuotient(scale.cwiseMax(1e-3 * scale.maxCoeff())).maxCoeff();
}

struct DerivativeCase {
  const char* name;
  std::function<RobotModel()> load;
  std::vector<int> contacts;
};

void PrintTo(const DerivativeCase& c, std::ostream* stream) { *stream << c.name; }

class ForwardDynamicsDerivatives : public testing::TestWithParam<DerivativeCase> {};

// At any v, J v != 0 too.
TEST_P(ForwardDynamicsDerivatives, AgreeWithCentralDifferences) {
  const RobotModel robot = GetParam().load();
  ForwardDynamics dynamics(robot, GetParam().contacts), probe(robot, GetParam().contacts);
  NullSpaceDynamics reference(robot, GetParam().contacts);
  RandomStates random(robot, 6, 0.5);
  const auto a_then_f = [&](const VectorXd& q, const VectorXd& v, const VectorXd& tau) {
    probe.evaluate(q, v, tau);
    VectorXd result(probe.acceleration().size() + probe.forces().size());
    result << probe.acceleration(), probe.forces();
    return result;
  };
  double worst_a = 0.0, worst_f = 0.0;
  for (int i = 0; i < 10; ++i) {
    Sample s = sample_on_contacts(random, reference);
    s.v = random.velocity();
    dynamics.evaluate_with_derivatives(s.q, s.v, s.tau);
    const auto check = [&](const MatrixXd& da, const MatrixXd& df, double step, const Function& y) {
      const MatrixXd expected = central_differences(y, da.cols(), step);
      worst_a = std::max(worst_a, worst_column(da, expected.topRows(robot.nv())));
      worst_f = std::max(worst_f, worst_column(df, expected.bottomRows(expected.rows() - robot.nv())));
    };
    const auto& da = dynamics.acceleration_derivatives();
    const auto& df = dynamics.force_derivatives();
    check(da.q, df.q, 1e-3, [&](const VectorXd& d) { return a_then_f(integrate(s.q, d), s.v, s.tau); });
    // Quadratic in v and linear in tau, so that differences are exact at any step, and a large one rounds least.
    check(da.v, df.v, 1.0, [&](const VectorXd& d) { return a_then_f(s.q, s.v + d, s.tau); });
    check(da.tau, df.tau, 1.0, [&](const VectorXd& d) { return a_then_f(s.q, s.v, s.tau + d); });
  }
  fmt::print("{}: derivatives of a {:.1e}, of f {:.1e}\n", GetParam().name, worst_a, worst_f);
  EXPECT_LT(worst_a, 1e-6);
  EXPECT_LT(worst_f, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(All, ForwardDynamicsDerivatives,
                         testing::Values(DerivativeCase{"HyqFourFeet", test::hyq, {0, 1, 2, 3}},
                                         DerivativeCase{"HyqDiagonalFeet", test::hyq, {0, 3}},
                                         DerivativeCase{"HyqInFlight", test::hyq, {}},
                                         DerivativeCase{"HyqFourFeetTwice", test::hyq, kFourFeetTwice},
                                         DerivativeCase{"Solo12ThreeFeet", test::solo12, {0, 1, 2}},
                                         DerivativeCase{"TalosBothSoles", test::talos, kBothSoles}),
                         testing::PrintToStringParamName());

/// Torques are generalised forces on the joints.
TEST(ForwardDynamicsTest, ForcesActLikeTorques) {
  const RobotModel robot = test::hyq();
  for (const std::vector<int>& contacts : {std::vector<int>{0, 1, 2, 3}, std::vector<int>{1, 2}}) {
    ForwardDynamics dynamics(robot, contacts);
    RandomStates random(robot, 1);
    for (int i = 0; i < 20; ++i) {
      dynamics.evaluate_with_derivatives(random.configuration(), random.velocity(), random.torque());
      const auto [a, f] = dynamics.response(MatrixXd::Identity(robot.nv(), robot.nv()).rightCols(robot.nu()));
      EXPECT_LT((a - dynamics.acceleration_derivatives().tau).norm(), 1e-9 * a.norm());
      EXPECT_LT((f - dynamics.force_derivatives().tau).norm(), 1e-9 * f.norm());
    }
  }
}

}  // namespace
}  // namespace prowl
