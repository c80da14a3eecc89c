#include "prowl/certificate/reintegration.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <limits>

#include "prowl/certificate/worst_case.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/trajectory/state_scale.hpp"

namespace prowl {
namespace {

constexpr double kTolerance = 1e-10;  // absolute and relative, of each coordinate
constexpr int kMaxSteps = 2000;       // an interval takes about ten; with more the dynamics diverge

using State = std::vector<double>;  // q, v

struct EndState {
  Eigen::VectorXd q, v;
};

/// ẋ = f(x, τ(t)) with the base orientation as a quaternion: d/dt quat = 1/2 quat ω.
State state_rate(const State& x, const Eigen::VectorXd& tau, ConstrainedDynamicsOracle& dynamics) {
  const Eigen::Index nv = tau.size() + 6;
  Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(x.data(), nv + 1);
  const Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(x.data() + nv + 1, nv);
  // A diverged state stays NaN: Pinocchio with assertions would end the program on it.
  if (!q.allFinite()) return State(x.size(), std::numeric_limits<double>::quiet_NaN());
  q.segment<4>(3).normalize();
  const Eigen::Quaterniond turn = base_quaternion(q);
  const Eigen::Quaterniond spin = turn * Eigen::Quaterniond(0.0, 0.5 * v(3), 0.5 * v(4), 0.5 * v(5));

  State rate(x.size());
  Eigen::Map<Eigen::VectorXd> q_rate(rate.data(), nv + 1), v_rate(rate.data() + nv + 1, nv);
  q_rate << turn * v.head<3>(), spin.coeffs(), v.tail(tau.size());
  v_rate = dynamics.acceleration(q, v, tau);
  return rate;
}

EndState reintegrate(const MeshInterval& interval, ConstrainedDynamicsOracle& dynamics) {
  namespace odeint = boost::numeric::odeint;
  const TrajectoryPoint& left = interval.left;
  const double h = interval.step();
  const auto rate = [&](const State& x, State& x_rate, double t) {
    x_rate = state_rate(x, interval.torque(t), dynamics);
  };

  State x(left.q.data(), left.q.data() + left.q.size());
  x.insert(x.end(), left.v.data(), left.v.data() + left.v.size());
  auto stepper = odeint::make_controlled(kTolerance, kTolerance, odeint::runge_kutta_dopri5<State>());
  double t = 0.0, dt = h / 4;
  for (int steps = 0; h - t > 1e-12 * h; ++steps) {
    if (steps == kMaxSteps) x.assign(x.size(), std::numeric_limits<double>::quiet_NaN());
    if (steps == kMaxSteps || !(dt > 0.0)) break;
    dt = std::min(dt, h - t);
    stepper.try_step(rate, x, t, dt);
  }

  EndState end{Eigen::Map<Eigen::VectorXd>(x.data(), left.q.size()),
               Eigen::Map<Eigen::VectorXd>(x.data() + left.q.size(), left.v.size())};
  end.q.segment<4>(3).normalize();
  return end;
}

}  // namespace

ReintegrationErrors reintegration_errors(const RobotModel& robot, const Trajectory& trajectory,
                                         PhaseDynamics& dynamics) {
  const Eigen::VectorXd scale = state_scale(trajectory);
  WorstCase worst("re-integration", "-", CertificateLimits::reintegration_draft,
                  CertificateLimits::reintegration_certified);
  ReintegrationErrors result;
  for (const MeshInterval& interval : mesh_intervals(trajectory)) {
    const EndState end = reintegrate(interval, dynamics[interval.left.phase]);
    const Eigen::VectorXd delta = scaled_difference(end.q, end.v, interval.right.q, interval.right.v, scale);
    Eigen::Index i = 0;
    const double largest = delta.cwiseAbs().maxCoeff<Eigen::PropagateNaN>(&i);
    result.intervals.push_back(largest);
    worst.record(largest, interval.left.time, state_name(robot, i));
  }
  result.check = worst.check();
  return result;
}

}  // namespace prowl
