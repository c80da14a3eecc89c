#include <gtest/gtest.h>

#include <boost/numeric/odeint/integrate/integrate_times.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <vector>

#include "prowl/certificate/constrained_dynamics_oracle.hpp"
#include "prowl/transcription/deferred_correction.hpp"
#include "prowl/transcription/transcription.hpp"
#include "tests/support/given_torques.hpp"

// How fast what a rule makes of given torques goes to the true motion.

namespace prowl {
namespace {

using test::end_of_given_motion;
using test::state_error;
using test::StateError;

void expect_order(double order, const Formulation& formulation, const TrajectoryPoint& truth) {
  const StateError coarse = state_error(end_of_given_motion(formulation, 8), truth);
  const StateError fine = state_error(end_of_given_motion(formulation, 16), truth);
  SCOPED_TRACE(formulation.dynamics + ", " + formulation.transcription);
  EXPECT_NEAR(std::log2(coarse.q / fine.q), order, 0.35) << coarse.q << " -> " << fine.q;
  EXPECT_NEAR(std::log2(coarse.v / fine.v), order, 0.35) << coarse.v << " -> " << fine.v;
}

TEST(Order, TrapezoidIsOfOrderTwoHermiteSimpsonAndRungeKuttaOfOrderFour) {
  const TrajectoryPoint truth = end_of_given_motion({.transcription = "hermite-simpson"}, 128);
  const MotionProblem problem = test::given_motion(1).problem;
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(problem.robot.nv());
  EXPECT_GT(state_error(truth, {.q = problem.start_configuration(), .v = at_rest, .force = truth.force}).q, 0.02)
      << "nothing moves";
  expect_order(2.0, {}, truth);
  expect_order(2.0, {.dynamics = "forward"}, truth);
  for (const std::string dynamics : {"inverse", "forward", "kkt"}) {
    expect_order(4.0, {.dynamics = dynamics, .transcription = "hermite-simpson"}, truth);
  }
  expect_order(4.0, {.transcription = "hermite-simpson-separated"}, truth);
  expect_order(4.0, {.dynamics = "forward", .transcription = "rk4"}, truth);
}

/// The given motion by Runge-Kutta with the dynamics of the certificate, at the nodes of equal intervals.
Trajectory true_motion(int intervals, test::Given start) {
  namespace odeint = boost::numeric::odeint;
  using State = std::vector<double>;
  const MotionProblem problem = test::given_motion(1, start).problem;
  ConstrainedDynamicsOracle dynamics(problem.robot, contact_indices(problem.phases[0].contacts));
  const Eigen::Index nq = problem.robot.nq(), nv = problem.robot.nv();
  const auto point_at = [&](const State& x, double t) {
    TrajectoryPoint point{.time = t,
                          .q = Eigen::Map<const Eigen::VectorXd>(x.data(), nq),
                          .v = Eigen::Map<const Eigen::VectorXd>(x.data() + nq, nv),
                          .tau = test::given_torques(problem, t)};
    point.q.segment<4>(3).normalize();
    const ConstrainedDynamicsOracle::Motion motion = dynamics.evaluate(point.q, point.v, point.tau);
    point.a = motion.a;
    point.force = motion.force;
    return point;
  };
  const auto rate = [&](const State& x, State& x_rate, double t) {
    const TrajectoryPoint point = point_at(x, t);
    const Eigen::Quaterniond turn = base_quaternion(point.q);
    const Eigen::Quaterniond spin =
        turn * Eigen::Quaterniond(0.0, 0.5 * point.v(3), 0.5 * point.v(4), 0.5 * point.v(5));
    Eigen::VectorXd rates(nq + nv);
    rates << turn * point.v.head<3>(), spin.coeffs(), point.v.tail(nv - 6), point.a;
    x_rate.assign(rates.begin(), rates.end());
  };
  const Eigen::VectorXd q0 = problem.start_configuration(), v0 = problem.start().velocity_lower;
  State x(q0.begin(), q0.end());
  x.insert(x.end(), v0.begin(), v0.end());
  std::vector<double> times;
  for (int k = 0; k <= intervals; ++k) times.push_back(test::kGivenDuration * k / intervals);
  Trajectory motion;
  odeint::integrate_times(odeint::make_controlled(1e-13, 1e-13, odeint::runge_kutta_dopri5<State>()), rate, x, times,
                          1e-3, [&](const State& at, double t) { motion.nodes.push_back(point_at(at, t)); });
  return motion;
}

/// Largest errors of the trapezoid's motion after so many corrections, each along the motion before.
StateError corrected_error(int intervals, int corrections, test::Given start) {
  const DiscreteProblem discrete = test::given_motion(intervals, start);
  const Trajectory truth = true_motion(intervals, start);
  Trajectory motion = truth;
  for (int i = 0; i <= corrections; ++i) {
    Transcription nlp(discrete, motion, i == 0 ? Corrections{} : deferred_corrections(discrete, motion));
    const SolveResult result = IpoptSolver().solve(nlp, nlp.pack(motion), {.tolerance = 1e-10, .max_iterations = 60});
    EXPECT_EQ(result.status, SolveStatus::converged) << result.message;
    motion = nlp.unpack(result.z);
  }
  StateError largest{0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < truth.nodes.size(); ++k) {
    const TrajectoryPoint &a = motion.nodes[k], &b = truth.nodes[k];
    largest.q = std::max(largest.q, difference(a.q, b.q).norm());
    largest.v = std::max(largest.v, (a.v - b.v).norm());
    largest.force = std::max(largest.force, (a.force - b.force).norm());
  }
  return largest;
}

TEST(Order, CorrectionsMakeTheTrapezoidOneOfFourthOrder) {
  constexpr int kMany = 8;
  for (const test::Given start : {test::Given::standing, test::Given::tumbling}) {
    SCOPED_TRACE(start == test::Given::standing ? "standing" : "tumbling");
    const StateError plain = corrected_error(48, 0, start), coarse = corrected_error(48, kMany, start),
                     fine = corrected_error(96, kMany, start);
    EXPECT_NEAR(std::log2(coarse.q / fine.q), 4.0, 0.2) << coarse.q << " -> " << fine.q;
    EXPECT_NEAR(std::log2(coarse.v / fine.v), 4.0, 0.2) << coarse.v << " -> " << fine.v;
    EXPECT_LT(coarse.q, 1e-3 * plain.q);
    EXPECT_LT(coarse.v, 1e-3 * plain.v);
    if (start == test::Given::tumbling) continue;
    EXPECT_NEAR(std::log2(coarse.force / fine.force), 4.0, 0.2) << coarse.force << " -> " << fine.force;
  }
}

}  // namespace
}  // namespace prowl
