#include "prowl/online/online_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/torque_share.hpp"
#include "prowl/mpc/stepping_patterns.hpp"
#include "prowl/online/online_measures.hpp"
#include "prowl/simulation/actuators.hpp"
#include "prowl/simulation/collision_shapes.hpp"
#include "prowl/simulation/ground_error.hpp"
#include "prowl/simulation/onboard.hpp"
#include "prowl/simulation/sensors.hpp"
#include "prowl/text/option_check.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// A foot's contact switch closes at this share of its even load. Choice: above the noise of real switches.
constexpr double kSwitchLoad = 0.05;
constexpr std::size_t kMostNotes = 20;
constexpr double kAfterPush = 0.5;  ///< plans so long after a push count as disturbed [s]
constexpr double kBeyond = 1.01;    ///< share of a limit that is beyond it, where encoders are noisy

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Throws InputError for an option out of range; `nu`: number of joints.
void check(const OnlineOptions& options, int nu) {
  check_option(options.duration > 0.0 && options.duration <= 1e5, "duration", options.duration,
               "more than 0, at most 1e5 s");
  check_option(options.period >= 1e-3 && options.period <= 0.2, "period", options.period, "0.001 to 0.2 s");
  check_option(options.budget >= 0.0 && options.budget <= 0.2, "budget", options.budget, "0 to 0.2 s");
  check_simulation_options(options.simulation, nu);
  checked(options.mpc);
  check_option(options.simulation.delay >= 0.0 && options.simulation.delay <= 0.05, "delay", options.simulation.delay,
               "0 to 0.05 s");
  check_option(options.budget + options.simulation.delay <= LatestPlans::kLongestDelay * options.period, "budget",
               options.budget, "at most seven periods, together with the delay");
  double last = -std::numeric_limits<double>::infinity();
  for (const TimedCommand& timed : options.commands) {
    check_option(timed.time >= last, "commands", timed.time, "times in ascending order");
    last = timed.time;
  }
  for (const double seconds : options.replayed_times)
    check_option(seconds >= 0.0 && std::isfinite(seconds), "replayed time", seconds, "a finite number >= 0 s");
}

/// A posture on level ground, turned about the origin with the ground.
VectorXd on_ground(VectorXd q, const Surface& ground) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ground.normal);
  q.head<3>() = ground.point + turn * (q.head<3>() - Eigen::Vector3d(ground.point.x(), ground.point.y(), 0.0));
  set_base_rotation(q, turn * base_rotation(q));
  return q;
}

std::unique_ptr<OnlineController> make_controller(const RobotModel& robot, const OnlineOptions& options,
                                                  const VectorXd& q) {
  MpcOptions mpc = options.mpc;
  mpc.delay = options.budget + options.simulation.delay;
  if (options.planner) return std::make_unique<OutsideController>(robot, options.planner, mpc.delay, q, 0.0);
  return std::make_unique<MpcController>(robot, mpc, q, VectorXd::Zero(robot.nv()), 0.0);
}

class Run {
 public:
  Run(const RobotModel& robot, const OnlineOptions& options)
      : robot_(robot),
        options_(options),
        period_(options.simulation.control_period()),
        substeps_(options.simulation.substeps()),
        standing_(standing_on_ground(robot)),
        ground_(ground_of(options)),
        start_(on_ground(standing_, ground_)),
        mpc_(make_controller(robot, options, start_)),
        physics_(robot, {ground_}, options.simulation.stepped_physics()),
        sensors_(robot.nu(), options.simulation.noise, options.simulation.noise_scale, options.simulation.seed),
        stand_{std::vector<bool>(robot.contacts().size(), true),
               std::vector<Eigen::Vector3d>(robot.contacts().size(), Eigen::Vector3d::UnitZ())},
        estimator_(robot, start_, VectorXd::Zero(robot.nv()), stand_,
                   estimator_noise(options.simulation.noise, options.simulation.noise_scale), kJointDensity),
        touches_(mpc_->feet().size(), true),
        pushes_(options.simulation.pushes),
        measures_(robot, mpc_->feet(), options.mpc.friction, options.duration, standing_.z()) {
    mpc_->torque(0.0, start_, VectorXd::Zero(robot.nv()), tau_);
    actuators_.emplace(robot, period_ / substeps_, options.simulation.delay + options.simulation.unknown_delay,
                       options.simulation.bandwidth, tau_);
    for (const TimedCommand& timed : options.commands) {
      if (!timed.gait.empty()) pattern_of(timed.gait);  // throws before the run if the robot cannot do it
    }
    tell_what_comes_too_late();
    pending_.assign(1 + static_cast<std::size_t>(std::lround(options.simulation.delay / period_)), tau_);
    follow(options.gait);
    physics_.set_state(start_, VectorXd::Zero(robot.nv()));
    if (const auto& shapes = options.simulation.physics.collisions) {
      for (const std::string& reason : shapes->unreadable) note("collides with nothing: " + reason);
    }
  }

  OnlineResult operator()(const OnlineWatcher& watch) {
    const long ticks = std::lround(options_.duration / period_);
    const double rate = options_.simulation.record_rate;
    const long record_each = rate > 0.0 ? std::max(1L, std::lround(1.0 / (rate * period_))) : 0;
    long tick = 0;
    for (; tick < ticks && result_.end == OnlineResult::End::finished; ++tick) {
      const double t = static_cast<double>(tick) * period_;
      if (record_each > 0 && tick % record_each == 0) result_.samples.push_back(sample(t));
      if (watch && !ask(watch, t)) {
        result_.end = OnlineResult::End::stopped;
        break;
      }
      sense(t);
      obey(t);
      if (t >= next_plan_ - kTimeRounding) plan(t);
      act(t);
      if (!advance(t)) result_.end = OnlineResult::End::diverged;
      if (!measures_.add_state(t, physics_, mpc_->followed(), ground_) && result_.end == OnlineResult::End::finished)
        result_.end = OnlineResult::End::fell;
    }
    result_.end_time = static_cast<double>(tick) * period_;
    result_.control_steps = tick;
    result_.counters = mpc_->counters();
    if (record_each > 0) result_.samples.push_back(sample(result_.end_time));
    measures_.finish(result_);
    return std::move(result_);
  }

 private:
  SteppingPattern pattern_of(const std::string& gait) const {
    return stepping_pattern(robot_, mpc_->feet(), standing_.z(), gait);
  }
  void follow(const std::string& gait) { mpc_->follow(pattern_of(gait)); }
  void tell_what_comes_too_late() {
    const auto tell = [&](const char* what, double time) {
      if (time >= options_.duration) note(fmt::format("{} at {:g} s is after the end of the run", what, time));
    };
    for (const TimedCommand& timed : options_.commands) tell("command", timed.time);
    for (const Push& push : options_.simulation.pushes) tell("push", push.time);
  }

  void sense(double t) {
    for (std::size_t f = 0; f < touches_.size(); ++f) {
      double load = 0.0;
      for (const int contact : mpc_->feet()[f]) load += physics_.contacts()[static_cast<std::size_t>(contact)].load;
      touches_[f] = t == 0.0 || load > kSwitchLoad * robot_.weight() / static_cast<double>(touches_.size());
      const bool stands = touches_[f] && !mpc_->timeline().swing(static_cast<int>(f), t);
      for (const int contact : mpc_->feet()[f]) stand_.in_contact[static_cast<std::size_t>(contact)] = stands;
    }
    const SensorReading reading = sensors_.read(physics_.q());
    if (options_.simulation.perfect_state) {
      estimator_.set(physics_.q(), physics_.v());
    } else if (t > 0.0) {
      estimator_.update(period_, reading, pending_.front(), stand_);
    }
    mpc_->feel_contacts(touches_, t);
  }

  OnlineSample sample(double t) const { return OnlineMeasures::sample(t, physics_, mpc_->followed()); }

  /// False if the watcher ends the run.
  bool ask(const OnlineWatcher& watch, double t) {
    const std::function<OnlineSample()> now = [&] { return sample(t); };
    OnlineMoment moment{.time = t, .end = options_.duration, .sample = now};
    watch(moment);
    if (moment.impulse) pushes_.push_back({*moment.impulse, t});
    if (moment.command) obey(t, *moment.command);
    return !moment.stops;
  }

  void obey(double t) {
    while (next_command_ < options_.commands.size() && options_.commands[next_command_].time <= t + kTimeRounding)
      obey(t, options_.commands[next_command_++]);
  }
  void obey(double t, const TimedCommand& timed) {
    if (!timed.gait.empty()) try_to_follow(timed.gait);
    const MpcCommand &asked = timed.command, kept = mpc_->command(asked);
    const auto text = [](const MpcCommand& c) {
      return fmt::format("{:.3g} m/s ahead, {:.3g} m/s left, {:.3g} rad/s, {:.3g} m up", c.forward, c.left, c.turn,
                         c.height);
    };
    if (kept != asked)
      note(fmt::format("command at {:.2f} s ({}) is out of range; followed: {}", t, text(asked), text(kept)));
  }
  void try_to_follow(const std::string& gait) {
    try {
      follow(gait);
    } catch (const InputError& error) {  // of a watcher: those of the options were tried before
      note(error.what());
    }
  }
  void note(const std::string& text) {
    if (result_.notes.size() < kMostNotes) result_.notes.push_back(text);
  }

  void plan(double t) {
    const double began = thread_seconds(), wall_began = wall_seconds();
    const bool is_ready = mpc_->prepare(t);
    const double prepared = thread_seconds();
    const bool has_plan = is_ready && mpc_->plan(estimator_.q(), estimator_.v(), t);
    const double ended = thread_seconds();
    result_.walls.push_back(wall_seconds() - wall_began);
    result_.feedbacks.push_back(ended - prepared);
    const std::size_t index = result_.times.size();
    if (index > 0 && index == options_.replayed_times.size())
      note(fmt::format("replayed times end at {:.2f} s; plans take their own from there on", t));
    const double seconds =
        index < options_.replayed_times.size() ? options_.replayed_times[index] : mpc_->computing_time(ended - began);
    result_.times.push_back(seconds);
    if (seconds > options_.budget) ++result_.late;
    const double period = options_.late == LatePlans::wait ? std::max(options_.period, seconds) : options_.period;
    next_plan_ = t + period;
    if (!has_plan) return;
    if (options_.late == LatePlans::wait) mpc_->act_from(t + seconds + options_.simulation.delay);
    if (options_.late == LatePlans::drop && seconds > options_.budget) {
      mpc_->drop_latest();
      ++result_.dropped;
      return;
    }
    measures_.add_plan(mpc_->latest(), period, is_pushed(t));
  }

  bool is_pushed(double t) const {
    return std::ranges::any_of(
        pushes_, [t](const Push& push) { return t >= push.time && t < push.time + push.duration + kAfterPush; });
  }

  void act(double t) {
    std::rotate(pending_.begin(), pending_.begin() + 1, pending_.end());
    q_ = estimator_.q();
    v_ = estimator_.v();
    double acts = t;
    for (std::size_t i = 0; i + 1 < pending_.size(); ++i, acts += period_)
      estimator_.predict(period_, pending_[i], stand_, q_, v_);
    mpc_->torque(acts, q_, v_, tau_);
    pending_.back() = tau_;
    command_ = tau_ + robot_.losses().torques(v_.tail(robot_.nu()));
    clamp_torques(robot_, q_, v_, command_);
    if (is_beyond_limits()) ++result_.steps_beyond_limits;
    actuators_->command(command_);
  }

  /// True if a commanded torque is beyond a limit at the true state, which the controller does not know.
  bool is_beyond_limits() const {
    for (int j = 0; j < robot_.nu(); ++j) {
      if (torque_share(robot_, j, physics_.q()(7 + j), physics_.v()(6 + j), command_(j)) > kBeyond) return true;
    }
    return false;
  }

  bool advance(double t) {
    const double step = period_ / substeps_;
    double share = 0.0;
    for (int i = 0; i < substeps_; ++i) {
      q_before_ = physics_.q();
      v_before_ = physics_.v();
      const VectorXd& torque = actuators_->step(q_before_, v_before_);
      share = std::max(share, actuators_->largest_share());
      if (!physics_.step(torque, push_at(pushes_, t + i * step))) return false;
      if (!physics_.other_touch().empty()) measures_.add_touch(physics_.other_touch());
      sensors_.integrate(step, q_before_, v_before_, physics_.q(), physics_.v());
    }
    result_.largest_torque_share = std::max(result_.largest_torque_share, share);
    return true;
  }

  const RobotModel& robot_;
  const OnlineOptions& options_;
  double period_;
  int substeps_;
  VectorXd standing_;
  Surface ground_;
  VectorXd start_;
  std::unique_ptr<OnlineController> mpc_;
  Physics physics_;
  Sensors sensors_;
  Stand stand_;
  StateEstimator estimator_;
  std::optional<Actuators> actuators_;
  std::vector<bool> touches_;
  std::vector<VectorXd> pending_;  ///< torques that do not act yet, oldest first; the first acts until the next reading
  std::size_t next_command_ = 0;
  double next_plan_ = 0.0;  ///< [s]
  VectorXd q_, v_, tau_, command_, q_before_, v_before_;
  std::vector<Push> pushes_;  ///< of the options, and of the watcher
  OnlineMeasures measures_;
  OnlineResult result_;
};

}  // namespace

const std::vector<std::string>& late_plans_names() {
  static const std::vector<std::string> names = {"act", "drop", "wait"};
  return names;
}

LatePlans late_plans_named(const std::string& name) {
  const auto found = std::ranges::find(late_plans_names(), name);
  if (found == late_plans_names().end())
    throw InputError(fmt::format("late: '{}' is not allowed; need act, drop or wait", name));
  return static_cast<LatePlans>(found - late_plans_names().begin());
}

std::vector<std::string> gaits_of(const OnlineOptions& options) {
  std::vector<std::string> gaits = {options.gait};
  for (const TimedCommand& timed : options.commands) {
    if (!timed.gait.empty() && timed.gait != gaits.back() && timed.time < options.duration) gaits.push_back(timed.gait);
  }
  return gaits;
}

Surface ground_of(const OnlineOptions& options) {
  const SimulationOptions& simulation = options.simulation;
  const Surface level{.name = "ground", .friction = simulation.physics.friction.value_or(options.mpc.friction)};
  return with_error({level}, Eigen::Vector3d::Zero(), simulation.ground).front();
}

OnlineResult run_online(const RobotModel& robot, const OnlineOptions& options, const OnlineWatcher& watch) {
  check(options, robot.nu());
  return Run(robot, options)(watch);
}

}  // namespace prowl
