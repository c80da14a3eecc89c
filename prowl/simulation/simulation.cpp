#include "prowl/simulation/simulation.hpp"

#include <fmt/format.h>

#include <cmath>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/simulation/actuators.hpp"
#include "prowl/simulation/ground_error.hpp"
#include "prowl/simulation/judge.hpp"
#include "prowl/simulation/measures.hpp"
#include "prowl/simulation/onboard.hpp"
#include "prowl/simulation/perturbations.hpp"
#include "prowl/simulation/sensors.hpp"
#include "prowl/text/option_check.hpp"

namespace prowl {
namespace {

/// Throws InputError for options out of range; `end` of the simulation [s].
void check(const MotionProblem& problem, const SimulationOptions& options, double end) {
  check_simulation_options(options, problem.robot.nu());
  for (const Push& push : options.pushes)
    check_option(push.time <= end, "push time", push.time, fmt::format("0 to {:g} s, the end of the simulation", end));
}

constexpr double kLoaded = 0.01;  ///< of the weight: a foot with less may slip

/// They turn about the place under the base at the start.
std::vector<Surface> real_ground(const MotionProblem& problem, const Tracker& tracker, const GroundError& error) {
  Eigen::VectorXd q(problem.robot.nq()), v(problem.robot.nv());
  tracker.reference(tracker.start(), q, v);
  const double height = problem.robot.nominal_configuration().z();
  return with_error(problem.surfaces, base_position(q) - height * Eigen::Vector3d::UnitZ(), error);
}

std::vector<int> held_at_start(const MotionProblem& problem) {
  std::vector<int> holds(problem.robot.contacts().size(), -1);
  for (const PhaseContact& held : problem.phases.front().contacts)
    holds[static_cast<std::size_t>(held.contact)] = held.surface;
  return holds;
}

/// What a robot that stands does not know of its state: a fifth of what a sweep draws.
StartError small_start_error(const MotionProblem& problem, const SimulationOptions& options) {
  if (options.perfect_state || options.noise_scale == 0.0) return {};
  constexpr double kShare = 0.2;
  constexpr std::uint64_t kOther = 0x9e3779b97f4a7c15;  // than the sensors'
  std::mt19937_64 random(options.seed ^ kOther);
  return draw_start_error(problem.robot, kShare, random);
}

/// A cycle ends in motion: after it there is nothing to stand in.
double end_of_simulation(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria) {
  return tracker.end() + (problem.cycle ? 0.0 : criteria.rest);
}

/// One run: physics and on-board software.
class Run {
 public:
  Run(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
      const SimulationOptions& options)
      : problem_(problem),
        tracker_(tracker),
        options_(options),
        period_(options.control_period()),
        substeps_(options.substeps()),
        end_(end_of_simulation(problem, tracker, criteria)),
        ground_(real_ground(problem, tracker, options.ground)),
        physics_(problem.robot, ground_, options.stepped_physics()),
        sensors_(problem.robot.nu(), options.noise, options.noise_scale * options.unknown_noise, options.seed),
        onboard_(problem, tracker, options, period_),
        actuators_(problem.robot, period_ / substeps_, options.delay + options.unknown_delay, options.bandwidth,
                   first_torque(tracker)),
        measures_(problem, tracker, physics_, end_),
        slip_(problem.robot.contacts().size()) {
    sample_.q_ref.resize(problem.robot.nq());
    sample_.v_ref.resize(problem.robot.nv());
    tracker.reference(tracker.start(), sample_.q_ref, sample_.v_ref);
    Eigen::VectorXd q = sample_.q_ref, v = sample_.v_ref;
    displace(physics_, ground_, held_at_start(problem), options.start.value_or(small_start_error(problem, options)), q,
             v);
    physics_.set_state(q, v);
  }

  SimulationResult operator()(const std::function<void(double, double)>& on_time) {
    std::vector<SimulationSample> samples;
    const long ticks = std::lround(end_ / period_), record_each = record_ticks();
    auto end = SimulationResult::End::finished;
    long tick = 0;
    for (; tick <= ticks && end == SimulationResult::End::finished; ++tick) {
      const double t = static_cast<double>(tick) * period_;
      if (on_time) on_time(t, end_);
      control(t);
      if (!advance(t)) end = SimulationResult::End::diverged;
      sample_.tau = torque_;
      sample_.contacts = physics_.contacts();
      if (end == SimulationResult::End::finished) measures_.add(sample_, slip_);
      if (record_each > 0 && tick % record_each == 0) samples.push_back(sample_);
      if (end == SimulationResult::End::finished && has_fallen(problem_.robot, sample_.q_ref, physics_.q())) {
        end = SimulationResult::End::fell;
      }
    }
    SimulationResult result = measures_.result();
    result.end = end;
    result.end_time = static_cast<double>(tick - 1) * period_;
    result.phase = tracker_.segment(result.end_time).name;
    result.samples = std::move(samples);
    return result;
  }

 private:
  static Eigen::VectorXd first_torque(const Tracker& tracker) {
    Eigen::VectorXd tau(tracker.plan().nu());
    tracker.feedforward(tracker.start(), tau);
    return tau;
  }
  long record_ticks() const {
    if (options_.record_rate <= 0.0) return 0;
    return std::max(1L, std::lround(options_.control_rate / options_.record_rate));
  }

  void control(double t) {
    sample_.time = t;
    sample_.q = physics_.q();
    sample_.v = physics_.v();
    tracker_.reference(t, sample_.q_ref, sample_.v_ref);
    const SensorReading reading = sensors_.read(physics_.q());
    if (options_.perfect_state) {
      onboard_.be_told(physics_.q(), physics_.v());
    } else if (t > 0.0) {
      onboard_.sense(t, reading);
    }
    sample_.q_seen = onboard_.q();
    sample_.v_seen = onboard_.v();
    onboard_.act(t);
    sample_.q_tracked = integrate(sample_.q_ref, onboard_.ground_correction());
    sample_.feedforward = onboard_.feedforward();
    sample_.feedback = onboard_.feedback();
    actuators_.command(onboard_.command());
  }

  bool advance(double t) {
    for (Eigen::Vector3d& slip : slip_) slip.setZero();
    const double step = period_ / substeps_;
    for (int i = 0; i < substeps_; ++i) {
      q_before_ = physics_.q();
      v_before_ = physics_.v();
      torque_ = actuators_.step(q_before_, v_before_);
      if (!physics_.step(torque_, push_at(options_.pushes, t + i * step))) return false;
      if (!physics_.other_touch().empty()) measures_.add_touch(physics_.other_touch(), t);
      sensors_.integrate(step, q_before_, v_before_, physics_.q(), physics_.v());
      for (std::size_t c = 0; c < slip_.size(); ++c) {
        const ContactReading& reading = physics_.contacts()[c];
        if (reading.load > kLoaded * problem_.robot.weight()) slip_[c] += step * reading.slip_velocity;
      }
      measures_.add_torques(actuators_, torque_, v_before_, step);
    }
    return true;
  }

  const MotionProblem& problem_;
  const Tracker& tracker_;
  const SimulationOptions& options_;
  double period_;
  int substeps_;
  double end_;
  std::vector<Surface> ground_;
  Physics physics_;
  Sensors sensors_;
  Onboard onboard_;
  Actuators actuators_;
  Measures measures_;
  SimulationSample sample_;
  std::vector<Eigen::Vector3d> slip_;
  Eigen::VectorXd torque_, q_before_, v_before_;
};

}  // namespace

const char* to_string(SimulationResult::End end) {
  switch (end) {
    case SimulationResult::End::finished: return "finished";
    case SimulationResult::End::fell: return "fell";
    case SimulationResult::End::diverged: return "diverged";
  }
  return "unknown";
}

SimulationResult simulate(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
                          const SimulationOptions& options, const std::function<void(double, double)>& on_time) {
  check_fit(problem, tracker);
  check(problem, options, end_of_simulation(problem, tracker, criteria));
  SimulationResult result = Run(problem, tracker, criteria, options)(on_time);
  result.failures = failures(result, problem, criteria);
  return result;
}

const Phase& phase_of_segment(const MotionProblem& problem, std::size_t segment) {
  return problem.phases[std::min(segment, problem.phases.size() - 1)];
}

void check_fit(const MotionProblem& problem, const Tracker& tracker) {
  const TrackingPlan& plan = tracker.plan();
  if (plan.joint_names != problem.robot.joint_names() || plan.contact_names.size() != problem.robot.contacts().size() ||
      (plan.segments.size() != problem.phases.size() && plan.segments.size() != problem.phases.size() + 1)) {
    throw InputError("the tracker is of another robot or of other phases than the plan");
  }
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    std::vector<bool> held(problem.robot.contacts().size(), false);
    for (const PhaseContact& contact : phase_of_segment(problem, s).contacts)
      held[static_cast<std::size_t>(contact.contact)] = true;
    if (held != plan.segments[s].in_contact)
      throw InputError(
          fmt::format("the tracker holds other contacts than the plan in phase '{}'", plan.segments[s].name));
  }
}

}  // namespace prowl
