#include "prowl/simulation/onboard.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/model/configuration.hpp"
#include "prowl/simulation/simulation.hpp"

namespace prowl {
namespace {

std::vector<Stand> make_stands(const MotionProblem& problem, const Tracker& tracker) {
  std::vector<Stand> stands;
  for (std::size_t s = 0; s < tracker.plan().segments.size(); ++s) {
    Stand& stand = stands.emplace_back();
    stand.in_contact = tracker.plan().segments[s].in_contact;
    stand.normals.assign(problem.robot.contacts().size(), Eigen::Vector3d::UnitZ());
    for (const PhaseContact& contact : phase_of_segment(problem, s).contacts) {
      stand.normals[contact.contact] = problem.surfaces[contact.surface].normal;
    }
  }
  return stands;
}

/// Knows the state of the plan at its start, which may move.
StateEstimator make_estimator(const MotionProblem& problem, const Tracker& tracker, const Stand& stand,
                              const SimulationOptions& options) {
  Eigen::VectorXd q(problem.robot.nq()), v(problem.robot.nv());
  tracker.reference(tracker.start(), q, v);
  return {problem.robot, q, v, stand, estimator_noise(options.noise, options.noise_scale), kJointDensity};
}

GroundEstimator make_ground_estimator(const MotionProblem& problem, const Tracker& tracker,
                                      const std::vector<Stand>& stands) {
  Eigen::VectorXd q(problem.robot.nq()), v(problem.robot.nv());
  tracker.reference(tracker.start(), q, v);
  std::vector<bool> footed(problem.robot.contacts().size(), false);
  for (const Stand& stand : stands) {
    for (std::size_t c = 0; c < footed.size(); ++c) footed[c] = footed[c] || stand.in_contact[c];
  }
  return {problem.robot, q, stands.front(), std::move(footed)};
}

}  // namespace

EstimatorNoise estimator_noise(const SensorNoise& sensors, double scale) {
  EstimatorNoise noise;
  noise.encoder = std::max(scale * sensors.encoder, 1e-5);
  noise.gyro = std::max(scale * sensors.gyro, 1e-5);
  noise.accelerometer = std::max(scale * sensors.accelerometer, 1e-4);
  noise.gyro_bias = noise.gyro;
  noise.accelerometer_bias = noise.accelerometer;
  return noise;
}

Onboard::Onboard(const MotionProblem& problem, const Tracker& tracker, const SimulationOptions& options, double period)
    : tracker_(tracker),
      options_(options),
      period_(period),
      stands_(make_stands(problem, tracker)),
      estimator_(make_estimator(problem, tracker, stands_.front(), options)),
      ground_(make_ground_estimator(problem, tracker, stands_)),
      losses_(problem.robot.losses()),
      feedforward_(problem.robot.nu()),
      feedback_(problem.robot.nu()),
      command_(problem.robot.nu()),
      ground_correction_(Eigen::VectorXd::Zero(problem.robot.nv())),
      q_planned_(problem.robot.nq()),
      v_planned_(problem.robot.nv()) {
  tracker.feedforward(tracker.start(), command_);
  tracker.reference(tracker.start(), q_planned_, v_planned_);
  commands_.assign(1 + static_cast<std::size_t>(std::lround(options.delay / period)), moving(command_));
}

void Onboard::sense(double t, const SensorReading& reading) {
  estimator_.update(period_, reading, commands_.front(), stand(t));
}

void Onboard::act(double t) {
  std::rotate(commands_.begin(), commands_.begin() + 1, commands_.end());
  q_ = estimator_.q();
  v_ = estimator_.v();
  tracker_.reference(t, q_planned_, v_planned_);
  ground_.update(period_, q_, q_planned_, stand(t), stand(t + GroundEstimator::kLead));
  double acts = t;
  for (std::size_t i = 0; i + 1 < commands_.size(); ++i, acts += period_) {
    estimator_.predict(period_, commands_[i], stand(acts), q_, v_);
  }
  tracker_.reference(acts, q_planned_, v_planned_);
  ground_correction_ = ground_.correction(q_planned_);
  tracker_.feedforward(acts, feedforward_);
  if (options_.open_loop) {
    feedback_.setZero();
  } else {
    tracker_.feedback(acts, integrate(q_, -ground_correction_), v_, feedback_);
  }
  command_ = feedforward_ + feedback_;
  tracker_.limit(q_, v_, command_);
  commands_.back() = moving(command_);
}

Eigen::VectorXd Onboard::moving(const Eigen::VectorXd& command) const {
  return command - losses_.torques(v_planned_.tail(command.size()));
}

const Stand& Onboard::stand(double t) const { return stands_[&tracker_.segment(t) - tracker_.plan().segments.data()]; }

}  // namespace prowl
