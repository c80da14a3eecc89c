#include "prowl/tracking/linearised_dynamics.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "prowl/model/configuration.hpp"
#include "tests/support/null_space_dynamics.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::relative_error;

struct Case {
  std::string name;
  RobotModel robot;
  std::vector<int> contacts;
  double window;  ///< of joint angles about the nominal posture [rad]
};

std::vector<Case> cases() {
  return {{"HyQ on four feet", test::hyq(), {0, 1, 2, 3}, 0.4},
          {"HyQ on two feet", test::hyq(), {0, 3}, 0.4},
          {"HyQ in the air", test::hyq(), {}, 0.4},
          {"HyQ, each foot twice", test::hyq(), {0, 1, 2, 3, 0, 1, 2, 3}, 0.4},
          {"Talos on both soles", test::talos(), {0, 1, 2, 3, 4, 5, 6, 7}, 0.3}};
}

struct Sample {
  VectorXd q, v, tau;
};

/// A state whose velocity the contacts allow.
Sample sample(test::RandomStates& random, test::NullSpaceDynamics& reference) {
  Sample s{random.configuration(), random.velocity(), random.torque()};
  reference.set_configuration(s.q);
  s.v = reference.N * (reference.N.transpose() * s.v);
  return s;
}

VectorXd moved(const VectorXd& q, const VectorXd& v, double time) {
  VectorXd step = time * v;
  step.head<3>() = base_rotation(q) * step.head<3>();
  return integrate(q, step);
}

/// d/dt of the deviation (q* ⊖ q, v* - v) between two states that move on, by central differences in time.
VectorXd deviation_rate(test::NullSpaceDynamics& dynamics, const Sample& from, const Sample& to) {
  constexpr double kTime = 1e-4;
  const auto deviation = [&](double time) { return difference(moved(from.q, from.v, time), moved(to.q, to.v, time)); };
  VectorXd rate(2 * from.v.size());
  rate.head(from.v.size()) = (deviation(kTime) - deviation(-kTime)) / (2.0 * kTime);
  dynamics.set_configuration(to.q);
  const VectorXd a = dynamics.solve(to.v, to.tau);
  dynamics.set_configuration(from.q);
  rate.tail(from.v.size()) = a - dynamics.solve(from.v, from.tau);
  return rate;
}

Sample deviated(const Sample& s, const VectorXd& dx, const VectorXd& dtau) {
  return {integrate(s.q, dx.head(s.v.size())), s.v + dx.tail(s.v.size()), s.tau + dtau};
}

TEST(LinearisedDynamics, AgreesWithFiniteDifferences) {
  for (Case& c : cases()) {
    LinearisedDynamics linear(c.robot, c.contacts);
    test::NullSpaceDynamics reference(c.robot, c.contacts);
    test::RandomStates random(c.robot, 1, c.window);
    const int nv = c.robot.nv(), nu = c.robot.nu();
    for (int i = 0; i < 5; ++i) {
      const Sample s = sample(random, reference);
      linear.evaluate(s.q, s.v, s.tau);
      constexpr double kStep = 1e-5;
      MatrixXd A(2 * nv, 2 * nv), B(2 * nv, nu);
      for (int j = 0; j < 2 * nv + nu; ++j) {
        VectorXd dx = VectorXd::Zero(2 * nv), dtau = VectorXd::Zero(nu);
        (j < 2 * nv ? dx(j) : dtau(j - 2 * nv)) = kStep;
        const VectorXd column = (deviation_rate(reference, s, deviated(s, dx, dtau)) -
                                 deviation_rate(reference, s, deviated(s, -dx, -dtau))) /
                                (2.0 * kStep);
        if (j < 2 * nv) {
          A.col(j) = column;
        } else {
          B.col(j - 2 * nv) = column;
        }
      }
      EXPECT_LT(relative_error(linear.A(), A), 1e-6) << c.name;
      EXPECT_LT(relative_error(linear.B(), B), 1e-6) << c.name;
    }
  }
}

// Contact points neither leave their places nor move: J of the deviated state times its velocity, and the way of the
// points.
TEST(LinearisedDynamics, DirectionsKeepTheContacts) {
  for (Case& c : cases()) {
    LinearisedDynamics linear(c.robot, c.contacts);
    test::NullSpaceDynamics reference(c.robot, c.contacts);
    test::RandomStates random(c.robot, 2, c.window);
    std::mt19937 rng(3);
    const int nv = c.robot.nv();
    const Sample s = sample(random, reference);
    const int rank = reference.rank;
    linear.evaluate(s.q, s.v, s.tau);
    const VectorXd weight =
        VectorXd::NullaryExpr(2 * nv, [&] { return std::pow(10.0, test::random_vector(rng, 1, 2.0)(0)); });
    const MatrixXd Z = linear.consistent_directions(weight);
    ASSERT_EQ(Z.cols(), 2 * nv - 2 * rank) << c.name;
    EXPECT_LT((Z.transpose() * weight.asDiagonal() * Z - MatrixXd::Identity(Z.cols(), Z.cols())).norm(), 1e-10);
    if (rank == 0) continue;
    EXPECT_LT((linear.C() * Z).norm(), 1e-9 * linear.C().norm() * Z.norm());
    EXPECT_LT((linear.C() * linear.B()).norm(), 1e-8 * linear.C().norm() * linear.B().norm());

    for (int i = 0; i < Z.cols(); ++i) {
      const VectorXd dx = 1e-6 * Z.col(i).normalized();
      const Sample there = deviated(s, dx, VectorXd::Zero(c.robot.nu()));
      reference.set_configuration(there.q);
      EXPECT_LT((reference.J * there.v).norm(), 1e-9) << c.name << ", velocity, direction " << i;
      // Of the points: J at the middle of the way, in the components of v (the base's in its own frame).
      VectorXd way = dx.head(nv);
      const VectorXd middle = integrate(s.q, 0.5 * way);
      way.head<3>() = base_rotation(middle).transpose() * way.head<3>();
      reference.set_configuration(middle);
      EXPECT_LT((reference.J * way).norm(), 1e-11) << c.name << ", position, direction " << i;
    }
    VectorXd off = VectorXd::Zero(2 * nv);
    off(2) = 1.0;  // the base up, joints where they are
    EXPECT_GT((linear.C() * off).norm(), 1e-3) << c.name;
  }
}

TEST(LinearisedDynamics, LandingEndsOnTheContactsWithTheirImpulsesOnly) {
  for (Case& c : cases()) {
    LinearisedDynamics linear(c.robot, c.contacts);
    test::NullSpaceDynamics reference(c.robot, c.contacts);
    test::RandomStates random(c.robot, 4, c.window);
    const int nv = c.robot.nv();
    const Sample s = sample(random, reference);
    reference.set_configuration(s.q);
    reference.solve(s.v, s.tau);
    linear.evaluate(s.q, s.v, s.tau);
    const VectorXd weight = VectorXd::LinSpaced(2 * nv, 1.0, 100.0);
    const MatrixXd L = linear.landing(weight);
    EXPECT_LT((linear.C() * L).norm(), 1e-9 * L.norm()) << c.name;
    EXPECT_LT((L * L - L).norm(), 1e-9 * L.norm()) << c.name << ": landing again changes nothing";
    const MatrixXd Z = linear.consistent_directions(weight);
    EXPECT_LT((L * Z - Z).norm(), 1e-9 * Z.norm()) << c.name << ": what the contacts allow stays";

    const VectorXd v = random.velocity();
    const VectorXd landed = velocity_after_landing(c.robot, c.contacts, s.q, v);
    EXPECT_LT((reference.J * landed).norm(), 1e-9) << c.name;
    EXPECT_LT((reference.N.transpose() * reference.M * (landed - v)).norm(), 1e-9 * (reference.M * v).norm())
        << c.name << ": momentum changes by contact impulses only";
    if (!c.contacts.empty()) EXPECT_GT((landed - v).norm(), 1e-2) << c.name;
    VectorXd dv = VectorXd::Zero(2 * nv);
    dv.tail(nv) = v;
    EXPECT_LT((VectorXd(L * dv).tail(nv) - landed).norm(), 1e-9 * v.norm()) << c.name << ": both landings are one";
  }
}

/// The impedance of the contacts accelerates their displacement as asked while the base stays, and gives nothing to
/// deviations that the contacts allow.
TEST(LinearisedDynamics, ImpedanceReturnsTheContactsAlone) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    test::RandomStates random(c.robot, c.window);
    test::NullSpaceDynamics reference(c.robot, c.contacts);
    const Sample s = sample(random, reference);
    const int nv = c.robot.nv(), nu = c.robot.nu();
    LinearisedDynamics linear(c.robot, c.contacts);
    linear.evaluate(s.q, s.v, s.tau);
    const VectorXd rates = VectorXd::LinSpaced(static_cast<Eigen::Index>(c.contacts.size()), 20.0, 50.0);
    const MatrixXd F = linear.impedance(rates);
    ASSERT_EQ(F.rows(), nu);
    if (c.contacts.empty()) {
      EXPECT_TRUE(F.isZero(0.0));
      continue;
    }
    const MatrixXd allowed = linear.consistent_directions(VectorXd::Ones(2 * nv));
    EXPECT_LT((F * allowed).norm(), 1e-9 * F.norm() * allowed.norm());
    if (c.contacts.size() != 4) continue;  // feet of their own
    RigidBodyTerms terms(c.robot);
    terms.update_with_derivatives(s.q, s.v, VectorXd::Zero(nv));
    ContactKinematics feet(c.contacts);
    feet.set_configuration(terms);
    std::mt19937 generator(7);
    VectorXd dx = test::random_vector(generator, 2 * nv, 1.0);
    dx.tail(nv).setZero();  // and the velocity of the contacts depends on q only through s.v
    feet.set_motion(VectorXd::Zero(nv), s.v);
    MatrixXd turned;
    feet.acceleration_dq(turned);
    const VectorXd e = feet.positions_dq() * dx.head(nv), rate = turned * dx.head(nv);
    VectorXd wanted(12);
    for (int i = 0; i < 4; ++i)
      wanted.segment<3>(3 * i) = -0.25 * rates(i) * rates(i) * e.segment<3>(3 * i) - rates(i) * rate.segment<3>(3 * i);
    const VectorXd joints = terms.mass_matrix().bottomRightCorner(nu, nu).llt().solve(-(F * dx));
    EXPECT_LT((feet.jacobian().rightCols(nu) * joints - wanted).norm(), 0.05 * wanted.norm());
  }
}

}  // namespace
}  // namespace prowl
