#include "prowl/online/online_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>
#include <set>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/mpc/stepping_patterns.hpp"
#include "prowl/simulation/actuators.hpp"
#include "prowl/simulation/ground_error.hpp"
#include "prowl/simulation/onboard.hpp"
#include "prowl/simulation/sensors.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// A foot's contact switch closes at this share of its even load. Choice: above the noise of real switches.
constexpr double kSwitchLoad = 0.05;
/// A fall: the base lower than this share of its standing height, or tilted by this [rad].
constexpr double kFallHeight = 2.0 / 3.0, kFallTilt = 0.7;
constexpr double kMostLastVelocity = 0.1;  ///< [m/s], at success
constexpr double kLastSecond = 1.0;        ///< [s]
constexpr double kPathRate = 10.0;         ///< [Hz]

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void check(const OnlineOptions& options) {
  const auto need = [](bool ok, const char* name, double value, const char* range) {
    if (!ok) throw InputError(fmt::format("{}: {:g} is not allowed; need {}", name, value, range));
  };
  need(options.duration > 0.0 && options.duration <= 1e5, "duration", options.duration, "more than 0, at most 1e5 s");
  need(options.period >= 1e-3 && options.period <= 0.2, "period", options.period, "0.001 to 0.2 s");
  need(options.budget >= 0.0 && options.budget <= 0.2, "budget", options.budget, "0 to 0.2 s");
  need(options.mpc.friction > 0.0 && std::isfinite(options.mpc.friction), "friction", options.mpc.friction, "> 0");
  need(options.simulation.delay >= 0.0 && options.simulation.delay <= 0.05, "delay", options.simulation.delay,
       "0 to 0.05 s");
}

Surface real_ground(const OnlineOptions& options) {
  const SimulationOptions& simulation = options.simulation;
  const Surface level{.name = "ground", .friction = simulation.physics.friction.value_or(options.mpc.friction)};
  return with_error({level}, Eigen::Vector3d::Zero(), simulation.ground).front();
}

class Run {
 public:
  Run(const RobotModel& robot, const OnlineOptions& options)
      : robot_(robot),
        options_(options),
        period_(options.simulation.control_period()),
        substeps_(options.simulation.substeps()),
        standing_(standing_on_ground(robot)),
        mpc_(robot, with_delay(options), standing_, VectorXd::Zero(robot.nv()), 0.0),
        ground_(real_ground(options)),
        physics_(robot, {ground_}, options.simulation.stepped_physics()),
        sensors_(robot.nu(), options.simulation.noise, options.simulation.noise_scale, options.simulation.seed),
        stand_{std::vector<bool>(robot.contacts().size(), true),
               std::vector<Eigen::Vector3d>(robot.contacts().size(), Eigen::Vector3d::UnitZ())},
        estimator_(robot, standing_, VectorXd::Zero(robot.nv()), stand_,
                   estimator_noise(options.simulation.noise, options.simulation.noise_scale), kJointDensity),
        touches_(mpc_.feet().size(), true) {
    mpc_.torque(0.0, standing_, VectorXd::Zero(robot.nv()), tau_);
    actuators_.emplace(robot, period_ / substeps_, options.simulation.delay + options.simulation.unknown_delay,
                       options.simulation.bandwidth, tau_);
    pending_.assign(1 + static_cast<std::size_t>(std::lround(options.simulation.delay / period_)), tau_);
    follow(options.gait);
    physics_.set_state(standing_, VectorXd::Zero(robot.nv()));
  }

  OnlineResult operator()(const std::function<void(double, double)>& on_time) {
    const long ticks = std::lround(options_.duration / period_), each = std::lround(options_.period / period_);
    const long path_each = std::max(1L, std::lround(1.0 / (kPathRate * period_)));
    long tick = 0;
    for (; tick < ticks && result_.end == OnlineResult::End::finished; ++tick) {
      const double t = static_cast<double>(tick) * period_;
      if (on_time) on_time(t, options_.duration);
      sense(t);
      obey(t);
      if (tick % std::max(1L, each) == 0) plan(t);
      act(t);
      if (!advance(t)) result_.end = OnlineResult::End::diverged;
      measure(t);
      if (tick % path_each == 0) record(t);
    }
    finish(static_cast<double>(tick) * period_);
    return std::move(result_);
  }

 private:
  static MpcOptions with_delay(const OnlineOptions& options) {
    MpcOptions mpc = options.mpc;
    mpc.delay = options.budget + options.simulation.delay;
    return mpc;
  }

  void follow(const std::string& gait) { mpc_.follow(stepping_pattern(robot_, mpc_.feet(), standing_.z(), gait)); }

  void sense(double t) {
    for (std::size_t f = 0; f < touches_.size(); ++f) {
      double load = 0.0;
      for (const int contact : mpc_.feet()[f]) load += physics_.contacts()[static_cast<std::size_t>(contact)].load;
      touches_[f] = t == 0.0 || load > kSwitchLoad * robot_.weight() / static_cast<double>(touches_.size());
      const bool stands = touches_[f] && !mpc_.timeline().swing(static_cast<int>(f), t);
      for (const int contact : mpc_.feet()[f]) stand_.in_contact[static_cast<std::size_t>(contact)] = stands;
    }
    const SensorReading reading = sensors_.read(physics_.q());
    if (options_.simulation.perfect_state) {
      estimator_.set(physics_.q(), physics_.v());
    } else if (t > 0.0) {
      estimator_.update(period_, reading, pending_.front(), stand_);
    }
    mpc_.feel_contacts(touches_, t);
  }

  void obey(double t) {
    while (next_command_ < options_.commands.size() && options_.commands[next_command_].time <= t + 1e-9) {
      const TimedCommand& timed = options_.commands[next_command_++];
      mpc_.command(timed.command);
      if (!timed.gait.empty()) follow(timed.gait);
    }
  }

  void plan(double t) {
    const double began = thread_seconds();
    const bool has_plan = mpc_.update(estimator_.q(), estimator_.v(), t);
    double seconds = thread_seconds() - began;
    if (result_.times.size() < options_.replayed_times.size()) seconds = options_.replayed_times[result_.times.size()];
    result_.times.push_back(seconds);
    if (!has_plan) return;
    if (options_.late == LatePlans::drop && seconds > options_.budget) {
      mpc_.drop_latest();
      ++result_.dropped;
    }
  }

  void act(double t) {
    std::rotate(pending_.begin(), pending_.begin() + 1, pending_.end());
    q_ = estimator_.q();
    v_ = estimator_.v();
    double acts = t;
    for (std::size_t i = 0; i + 1 < pending_.size(); ++i, acts += period_)
      estimator_.predict(period_, pending_[i], stand_, q_, v_);
    mpc_.torque(acts, q_, v_, tau_);
    pending_.back() = tau_;
    command_ = tau_ + robot_.losses().torques(v_.tail(robot_.nu()));
    clamp_torques(robot_, q_, v_, command_);
    actuators_->command(command_);
  }

  bool advance(double t) {
    const double step = period_ / substeps_;
    for (int i = 0; i < substeps_; ++i) {
      q_before_ = physics_.q();
      v_before_ = physics_.v();
      const VectorXd& torque = actuators_->step(q_before_, v_before_);
      result_.largest_torque_share = std::max(result_.largest_torque_share, actuators_->largest_share());
      if (!physics_.step(torque, push_at(options_.simulation.pushes, t + i * step))) return false;
      if (!physics_.other_touch().empty()) touched_.insert(physics_.other_touch());
      sensors_.integrate(step, q_before_, v_before_, physics_.q(), physics_.v());
    }
    return true;
  }

  void measure(double t) {
    const VectorXd &q = physics_.q(), &v = physics_.v();
    const Eigen::Matrix3d rotation = base_rotation(q);
    const Eigen::Vector3d rpy = rpy_from_rotation(rotation), velocity = rotation * v.head<3>();
    const MpcCommand& command = mpc_.followed();
    const double c = std::cos(rpy.z()), s = std::sin(rpy.z());
    const Eigen::Vector2d off(c * velocity.x() + s * velocity.y() - command.forward,
                              c * velocity.y() - s * velocity.x() - command.left);
    velocity_squares_ += off.squaredNorm();
    turn_squares_ += std::pow((rotation * v.segment<3>(3)).z() - command.turn, 2);
    ++measured_;
    if (t >= options_.duration - kLastSecond) {
      last_off_ += off;
      ++last_count_;
    }
    const double above = ground_.normal.dot(q.head<3>() - ground_.point);
    const double tilt = std::acos(std::clamp(rotation(2, 2), -1.0, 1.0));
    if (result_.end == OnlineResult::End::finished && (above < kFallHeight * standing_.z() || tilt > kFallTilt))
      result_.end = OnlineResult::End::fell;
  }

  void record(double t) {
    const Eigen::Matrix3d rotation = base_rotation(physics_.q());
    Eigen::Matrix<double, 10, 1> row;
    row << t, physics_.q().head<3>(), rpy_from_rotation(rotation), rotation * physics_.v().head<3>();
    result_.path.push_back(row);
  }

  void finish(double end) {
    result_.end_time = end;
    const auto mean = [&](double squares) {
      return measured_ > 0 ? std::sqrt(squares / static_cast<double>(measured_)) : 0.0;
    };
    result_.velocity_error = mean(velocity_squares_);
    result_.turn_error = mean(turn_squares_);
    if (last_count_ > 0) result_.last_velocity = (last_off_ / static_cast<double>(last_count_)).norm();
    result_.counters = mpc_.counters();
    result_.touches.assign(touched_.begin(), touched_.end());
    if (result_.end == OnlineResult::End::fell) {
      result_.failures = {fmt::format("fell at {:.2f} s", end)};
      return;
    }
    if (result_.end == OnlineResult::End::diverged) {
      result_.failures = {fmt::format("the simulation diverged at {:.2f} s", end)};
      return;
    }
    for (const std::string& touch : result_.touches) result_.failures.push_back("touched: " + touch);
    if (result_.last_velocity > kMostLastVelocity)
      result_.failures.push_back(
          fmt::format("mean velocity of the last second {:.2f} m/s off the command; {:g} allowed",
                      result_.last_velocity, kMostLastVelocity));
  }

  const RobotModel& robot_;
  const OnlineOptions& options_;
  double period_;
  int substeps_;
  VectorXd standing_;
  MpcController mpc_;
  Surface ground_;
  Physics physics_;
  Sensors sensors_;
  Stand stand_;
  StateEstimator estimator_;
  std::optional<Actuators> actuators_;
  std::vector<bool> touches_;
  std::vector<VectorXd> pending_;  ///< torques that do not act yet, oldest first; the first acts until the next reading
  std::size_t next_command_ = 0;
  VectorXd q_, v_, tau_, command_, q_before_, v_before_;
  double velocity_squares_ = 0.0, turn_squares_ = 0.0;
  Eigen::Vector2d last_off_ = Eigen::Vector2d::Zero();
  long measured_ = 0, last_count_ = 0;
  std::set<std::string> touched_;
  OnlineResult result_;
};

}  // namespace

OnlineResult run_online(const RobotModel& robot, const OnlineOptions& options,
                        const std::function<void(double, double)>& on_time) {
  check(options);
  return Run(robot, options)(on_time);
}

}  // namespace prowl
