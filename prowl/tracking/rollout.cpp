#include "prowl/tracking/rollout.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <limits>

#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/tracking/linearised_dynamics.hpp"
#include "prowl/tracking/segment_contacts.hpp"
#include "prowl/trajectory/tracking_error.hpp"

namespace prowl {
namespace {

namespace odeint = boost::numeric::odeint;
using Eigen::VectorXd;

constexpr int kMostSteps = 20000;     // between two samples; more means divergence
constexpr double kWidestChart = 0.5;  // [rad]; rotation vectors are regular up to 2 pi

struct State {
  VectorXd q, v;
};

/// The robot on the contacts of one segment, with its torques.
class Motion {
 public:
  Motion(const RobotModel& robot, const Tracker& tracker, const RolloutOptions& options, int segment)
      : tracker_(tracker),
        losses_(robot.losses()),
        options_(options),
        segment_(segment),
        contacts_(contacts_of(tracker.plan().segments[segment])),
        dynamics_(robot, contacts_, kContactRankThreshold),
        last_moment_(segment + 1 < static_cast<int>(tracker.plan().segments.size())
                         ? std::nextafter(tracker.plan().segments[segment].end, tracker.start())
                         : std::numeric_limits<double>::infinity()),
        held_(VectorXd::Zero(robot.nu())),
        force_size_(3 * static_cast<Eigen::Index>(robot.contacts().size())) {}

  /// Updates the torque held until the next tick.
  void tick(double t, const State& x) { held_ = torque_now(t, x); }

  VectorXd torque(double t, const State& x) const { return options_.control_step > 0.0 ? held_ : torque_now(t, x); }

  const VectorXd& acceleration(double t, const State& x) {
    dynamics_.evaluate(x.q, x.v, moving(torque(t, x), x));
    return dynamics_.acceleration();
  }

  RolloutSample sample(double t, const State& x) {
    const VectorXd tau = torque(t, x);
    dynamics_.evaluate(x.q, x.v, moving(tau, x));
    RolloutSample result{t, x.q, x.v, tau, VectorXd::Zero(force_size_), segment_};
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      result.force.segment<3>(3 * contacts_[i]) = dynamics_.forces().segment<3>(3 * static_cast<Eigen::Index>(i));
    }
    return result;
  }

  const std::vector<int>& contacts() const { return contacts_; }

 private:
  /// What moves the links of a motor torque.
  VectorXd moving(const VectorXd& tau, const State& x) const { return tau - losses_.torques(x.v.tail(tau.size())); }

  VectorXd torque_now(double t, const State& x) const {
    t = std::min(t, last_moment_);  // at the end itself the tracker returns the next segment
    VectorXd tau(held_.size());
    if (options_.closed_loop) {
      tracker_.torque(t, x.q, x.v, tau);
    } else {
      tracker_.feedforward(t, tau);
      tracker_.limit(x.q, x.v, tau);
    }
    return tau;
  }

  const Tracker& tracker_;
  const JointLosses& losses_;
  const RolloutOptions& options_;
  int segment_;
  std::vector<int> contacts_;
  ForwardDynamics dynamics_;
  double last_moment_;
  VectorXd held_;
  Eigen::Index force_size_;
};

/// Integrates from t to `end`, adaptively, in local coordinates y = (d, v), q = q0 ⊕ d, about the state at t. False if
/// it takes too many steps.
class Integrator {
 public:
  explicit Integrator(const RolloutOptions& options)
      : stepper_(
            odeint::make_controlled(options.tolerance, options.tolerance, odeint::runge_kutta_dopri5<Coordinates>())) {}

  bool integrate_to(double end, double& t, State& x, Motion& motion) {
    const Eigen::Index nv = x.v.size();
    VectorXd origin = x.q;
    Coordinates y(static_cast<std::size_t>(2 * nv), 0.0);
    Eigen::Map<VectorXd> d(y.data(), nv), v(y.data() + nv, nv);
    v = x.v;
    const auto rate = [&](const Coordinates& at, Coordinates& y_rate, double time) {
      const Eigen::Map<const VectorXd> at_d(at.data(), nv), at_v(at.data() + nv, nv);
      const State state{integrate(origin, at_d), at_v};
      Eigen::Map<VectorXd> d_rate(y_rate.data(), nv), v_rate(y_rate.data() + nv, nv);
      d_rate = state.v;
      d_rate.head<3>() = base_rotation(state.q) * state.v.head<3>();
      d_rate.segment<3>(3) = so3::right_jacobian_inverse(at_d.segment<3>(3)) * state.v.segment<3>(3);
      v_rate = motion.acceleration(time, state);
    };
    stepper_.reset();  // forget the last rate: other chart or contacts
    for (int steps = 0; end - t > 1e-12; ++steps) {
      if (steps == kMostSteps || !(step_ > 1e-12)) return false;
      double step = std::min(step_, end - t);
      const bool whole = step == step_;
      const auto result = stepper_.try_step(rate, y, t, step);
      if (whole || result == odeint::fail) step_ = step;  // a shortened last step does not limit the next
      step_ = std::min(step_, kLongestStep);
      if (d.segment<3>(3).norm() > kWidestChart) {
        origin = integrate(origin, d);
        d.setZero();
        stepper_.reset();
      }
    }
    t = end;
    x.q = integrate(origin, d);
    x.v = v;
    return true;
  }

 private:
  using Coordinates = std::vector<double>;
  static constexpr double kLongestStep = 0.05;  // [s]
  odeint::controlled_runge_kutta<odeint::runge_kutta_dopri5<Coordinates>> stepper_;
  double step_ = 1e-3;
};

bool is_far(const RobotModel& robot, const Tracker& tracker, double t, const State& x) {
  if (!x.q.allFinite() || !x.v.allFinite()) return true;
  VectorXd q_reference(x.q.size()), v_reference(x.v.size());
  tracker.reference(t, q_reference, v_reference);
  return has_fallen(robot, q_reference, x.q);
}

}  // namespace

Rollout rollout(const RobotModel& robot, const Tracker& tracker, const VectorXd& q, const VectorXd& v,
                const RolloutOptions& options, const std::function<void(double, double)>& on_time) {
  const std::vector<TrackingPlan::Segment>& segments = tracker.plan().segments;
  const double step = options.control_step > 0.0 ? options.control_step : options.sample_step;
  Rollout result;
  Integrator integrator(options);
  State x{q, v};
  double t = tracker.start(), next_sample = t;
  long ticks = 0;
  try {
    for (std::size_t s = 0; s < segments.size(); ++s) {
      Motion motion(robot, tracker, options, static_cast<int>(s));
      if (s > 0) x.v = velocity_after_landing(robot, motion.contacts(), x.q, x.v);
      const double end = segments[s].end + (s + 1 == segments.size() ? options.stand_on : 0.0);
      motion.tick(t, x);
      while (end - t > 1e-9) {
        if (t >= next_sample - 1e-9) {
          result.samples.push_back(motion.sample(t, x));
          next_sample += options.sample_step;
        }
        const double tick = tracker.start() + static_cast<double>(ticks + 1) * step;
        const bool reaches_tick = tick <= end;
        result.fell = !integrator.integrate_to(reaches_tick ? tick : end, t, x, motion) || is_far(robot, tracker, t, x);
        result.end_time = t;
        if (on_time) on_time(t, segments.back().end + options.stand_on);
        if (result.fell) return result;
        if (!reaches_tick) continue;
        ++ticks;
        motion.tick(t, x);
      }
      if (s + 1 == segments.size()) result.samples.push_back(motion.sample(t, x));
    }
  } catch (const NumericalError&) {
    result.fell = true;
  }
  return result;
}

}  // namespace prowl
