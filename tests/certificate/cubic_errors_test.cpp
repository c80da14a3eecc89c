// Errors that the certificate finds in motions of cubics, against closed forms and a much finer integration.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prowl/certificate/integration_error.hpp"
#include "prowl/certificate/reintegration.hpp"
#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/trajectory/state_scale.hpp"
#include "tests/certificate/stance_motion.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

constexpr int kIntervals = 20;

/// A fall without torque that is off by gain s³/3 in height, gain s² in its rate: cubics carry it exactly.
Trajectory false_fall(const RobotModel& robot, double step, double gain) {
  Trajectory motion;
  motion.interpolation = Interpolation::hermite;
  for (int k = 0; k <= kIntervals; ++k) {
    const double s = step * k, g = RobotModel::kGravity;
    TrajectoryPoint node{.time = s,
                         .q = robot.nominal_configuration(),
                         .v = Eigen::VectorXd::Zero(robot.nv()),
                         .a = Eigen::VectorXd::Zero(robot.nv()),
                         .tau = Eigen::VectorXd::Zero(robot.nu()),
                         .force = Eigen::VectorXd(0)};
    node.q(2) += 2.0 * s - 0.5 * g * s * s + gain * s * s * s / 3.0;
    node.v(2) = 2.0 - g * s + gain * s * s;
    node.a(2) = -g + 2.0 * gain * s;
    motion.nodes.push_back(std::move(node));
  }
  return motion;
}

TEST(CubicErrors, AreThoseOfAFallInClosedForm) {
  const RobotModel robot = test::hyq();
  const double step = 0.02, gain = 0.3;
  const Trajectory motion = false_fall(robot, step, gain);
  PhaseDynamics dynamics;
  dynamics.emplace_back(robot, std::vector<int>{});
  const IntegrationErrors integral = integration_errors(robot, motion, dynamics);
  const ReintegrationErrors again = reintegration_errors(robot, motion, dynamics);
  const Eigen::VectorXd scale = state_scale(motion);
  const double q_scale = scale(2), v_scale = scale(robot.nv() + 2);
  double sum = 0.0;
  for (int k = 0; k < kIntervals; ++k) {
    const double s0 = step * k, s1 = s0 + step;
    const double in_rate = gain * (s1 * s1 - s0 * s0);  // of the acceleration's error, 2 gain s
    const double in_height = gain * ((s1 * s1 * s1 - s0 * s0 * s0) / 3.0 - s0 * s0 * step);
    const auto i = static_cast<std::size_t>(k);
    EXPECT_NEAR(integral.intervals[i].error, in_rate / v_scale, 1e-12);
    EXPECT_EQ(integral.intervals[i].where, "velocity of base z");
    EXPECT_NEAR(again.intervals[i], std::max(in_height / q_scale, in_rate / v_scale), 1e-9);
    sum += in_rate / v_scale;
  }
  EXPECT_NEAR(integral.checks[1].worst, sum, 1e-12) << "all of it lies within one second";
}

/// The state, one after the other: q, then v.
struct State {
  Eigen::VectorXd q, v;
};

/// Runge-Kutta's rule with so many steps, on the projected forward dynamics.
State finely_integrated(const MeshInterval& interval, int steps, ForwardDynamics& dynamics) {
  const auto rates = [&](const State& x, double t) {
    dynamics.evaluate(x.q, x.v, interval.torque(t));
    return State{tangent_rate({.q = x.q, .v = x.v}), dynamics.acceleration()};
  };
  const auto moved = [](const State& x, double h, const State& rate) {
    return State{integrate(x.q, h * rate.q), x.v + h * rate.v};
  };
  State x{interval.left.q, interval.left.v};
  const double h = interval.step() / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = h * i;
    const State k1 = rates(x, t), k2 = rates(moved(x, 0.5 * h, k1), t + 0.5 * h),
                k3 = rates(moved(x, 0.5 * h, k2), t + 0.5 * h), k4 = rates(moved(x, h, k3), t + h);
    x = moved(x, h / 6.0, {k1.q + 2.0 * k2.q + 2.0 * k3.q + k4.q, k1.v + 2.0 * k2.v + 2.0 * k3.v + k4.v});
  }
  return x;
}

TEST(CubicErrors, AreThoseOfAHundredTimesFinerIntegration) {
  test::StanceMotion stance(test::hyq(), 2.0, {0.05, 0.03, -0.10}, {0.06, 0.10, 0.08});
  const RobotModel& robot = stance.robot();
  Trajectory motion = stance.on_mesh(kIntervals);
  motion.interpolation = Interpolation::hermite;
  PhaseDynamics dynamics;
  dynamics.emplace_back(robot, stance.all_contacts());
  const ReintegrationErrors again = reintegration_errors(robot, motion, dynamics);
  const IntegrationErrors integral = integration_errors(robot, motion, dynamics);
  ForwardDynamics fine(robot, stance.all_contacts(), kContactRankThreshold);
  const Eigen::VectorXd scale = state_scale(motion);
  const std::vector<MeshInterval> intervals = mesh_intervals(motion);
  constexpr int kFiner = 100;
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    SCOPED_TRACE(k);
    const MeshInterval& interval = intervals[k];
    const State end = finely_integrated(interval, kFiner, fine);
    const double error =
        scaled_difference(end.q, end.v, interval.right.q, interval.right.v, scale).cwiseAbs().maxCoeff();
    EXPECT_GT(error, 1e-7) << "nothing to measure";
    EXPECT_NEAR(again.intervals[k], error, 1e-3 * error);

    Eigen::VectorXd sum = Eigen::VectorXd::Zero(2 * robot.nv());
    const double h = interval.step() / kFiner;
    for (int i = 0; i < kFiner; ++i) {  // midpoints
      const double s = h * (i + 0.5);
      const TrajectoryPoint point = interval.at(s);
      fine.evaluate(point.q, point.v, point.tau);
      sum.head(robot.nv()) += h * (interval.rate(s) - tangent_rate(point)).cwiseAbs();
      sum.tail(robot.nv()) += h * (point.a - fine.acceleration()).cwiseAbs();
    }
    // A residual that changes its sign within the interval costs five Gauss points up to some percent.
    const double largest = sum.cwiseQuotient(scale).maxCoeff();
    EXPECT_NEAR(integral.intervals[k].error, largest, 0.05 * largest);
  }
}

}  // namespace
}  // namespace prowl
