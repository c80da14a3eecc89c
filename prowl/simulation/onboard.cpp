#include "prowl/simulation/onboard.hpp"

#include <algorithm>

#include "prowl/model/configuration.hpp"

namespace prowl {
namespace {

// Joint accelerations that the plan does not have, as white noise [rad^2/s^3]: docs/simulation.md says how it was chosen.
constexpr double kJointDensity = 1.0;
constexpr double kLeastEncoderNoise = 1e-5;  // [rad]; of a filter that is told there is none

EstimatorNoise estimator_noise(const SensorNoise& sensors, double scale) {
  EstimatorNoise noise;
  noise.encoder = std::max(scale * sensors.encoder, kLeastEncoderNoise);
  noise.gyro = std::max(scale * sensors.gyro, 1e-5);
  noise.accelerometer = std::max(scale * sensors.accelerometer, 1e-4);
  noise.gyro_bias = noise.gyro;
  noise.accelerometer_bias = noise.accelerometer;
  return noise;
}

std::vector<std::vector<Eigen::Vector3d>> surface_normals(const MotionProblem& problem) {
  std::vector<std::vector<Eigen::Vector3d>> normals;
  for (const Phase& phase : problem.phases) {
    normals.emplace_back(problem.robot.contacts().size(), Eigen::Vector3d::UnitZ());
    for (const PhaseContact& contact : phase.contacts) {
      normals.back()[static_cast<std::size_t>(contact.contact)] =
          problem.surfaces[static_cast<std::size_t>(contact.surface)].normal;
    }
  }
  return normals;
}

}  // namespace

Onboard::Onboard(const MotionProblem& problem, const Tracker& tracker, const SimulationOptions& options)
    : problem_(problem),
      tracker_(tracker),
      joints_(problem.start_configuration().tail(problem.robot.nu()),
              std::max(options.noise_scale * options.noise.encoder, kLeastEncoderNoise), kJointDensity),
      base_(problem.robot, problem.start_configuration(), tracker.plan().segments.front().in_contact,
            estimator_noise(options.noise, options.noise_scale)),
      normals_(surface_normals(problem)),
      q_(problem.start_configuration()),
      v_(Eigen::VectorXd::Zero(problem.robot.nv())) {}

void Onboard::sense(double t, double dt, const SensorReading& reading) {
  const TrackingPlan::Segment& segment = tracker_.segment(t);
  const auto phase = static_cast<std::size_t>(&segment - tracker_.plan().segments.data());
  joints_.update(dt, planned_joint_acceleration(t - dt, t), reading.encoders);
  base_.update(dt, reading.gyro, reading.accelerometer, reading.encoders, joints_.rates(), segment.in_contact,
               normals_[phase]);
  const Eigen::Index nu = problem_.robot.nu();
  q_.head<3>() = base_.position();
  set_base_rotation(q_, base_.rotation());
  q_.tail(nu) = joints_.positions();
  v_.head<3>() = base_.rotation().transpose() * base_.velocity();
  v_.segment<3>(3) = base_.angular_velocity();
  v_.tail(nu) = joints_.rates();
}

void Onboard::be_told(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  q_ = q;
  v_ = v;
}

Eigen::VectorXd Onboard::planned_joint_acceleration(double from, double to) const {
  Eigen::VectorXd q(problem_.robot.nq()), before(problem_.robot.nv()), after(problem_.robot.nv());
  tracker_.reference(from, q, before);
  tracker_.reference(to, q, after);
  if (to <= from || to > tracker_.end()) return Eigen::VectorXd::Zero(problem_.robot.nu());
  return (after - before).tail(problem_.robot.nu()) / (to - from);
}

}  // namespace prowl
