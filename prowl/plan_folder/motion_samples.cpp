#include "prowl/plan_folder/motion_samples.hpp"

#include <fmt/format.h>

#include <cmath>

#include "prowl/error.hpp"
#include "prowl/plan_folder/trajectory_csv.hpp"
#include "prowl/plan_folder/motion_points.hpp"

namespace prowl {
namespace {

constexpr double kMostSamples = 1e6;

void check_rate(std::optional<double> rate, double duration) {
  if (!rate) return;
  if (!(*rate > 0.0 && std::isfinite(*rate) && *rate * duration <= kMostSamples)) {
    throw InputError(
        fmt::format("--rate: {} is not allowed; need more than 0 Hz and at most {:g}, which are {:g} samples in {} s",
                    *rate, std::floor(kMostSamples / duration), kMostSamples, duration));
  }
}

/// K at a point of the plan; at the end of a phase that phase's, where Tracker::gains takes the next one's.
Eigen::MatrixXd gains_at(const Tracker& tracker, const TrajectoryPoint& point) {
  const TrackingPlan& plan = tracker.plan();
  const auto& segment = plan.segments[point.phase];
  Eigen::MatrixXd K(plan.nu(), 2 * plan.nv());
  if (point.time < segment.end) {
    tracker.gains(point.time, K);
  } else {
    const Eigen::Index last = segment.first_sample + segment.samples - 1;
    K = Eigen::Map<const Eigen::MatrixXd>(plan.gains.col(last).data(), K.rows(), K.cols());
  }
  return K;
}

/// Phase at time t, of two the later; the last one goes on.
int phase_at(const Trajectory& trajectory, double t) { return sample(trajectory, t).phase; }

}  // namespace

std::vector<std::size_t> MotionSamples::one_a_time() const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + 1 == points.size() || points[i].time < points[i + 1].time) indices.push_back(i);
  }
  return indices;
}

MotionSamples sample_plan(const MotionProblem& problem, const Trajectory& trajectory, const Tracker* tracker,
                          std::optional<double> rate) {
  check_rate(rate, trajectory.duration());
  MotionSamples samples;
  samples.points = rate ? sample_uniformly(trajectory, 1.0 / *rate).nodes : trajectory.nodes;
  for (const TrajectoryPoint& point : samples.points) {
    std::vector<bool> touches(problem.robot.contacts().size(), false);
    for (const PhaseContact& contact : problem.phases[point.phase].contacts) {
      touches[contact.contact] = true;
    }
    samples.in_contact.push_back(std::move(touches));
    if (tracker) samples.gains.push_back(gains_at(*tracker, point));
  }
  return samples;
}

MotionSamples sample_simulation(const MotionProblem& problem, const Trajectory& trajectory, const CsvTable& simulation,
                                std::optional<double> rate) {
  check_rate(rate, trajectory.duration());
  MotionSamples samples;
  samples.simulated = true;
  samples.points = simulated_points(problem.robot, simulation, rate ? 1.0 / *rate : 0.0);
  if (samples.points.empty()) throw InputError(simulation.file + ": no row of finite numbers");
  for (TrajectoryPoint& point : samples.points) {
    point.phase = phase_at(trajectory, point.time);
    std::vector<bool> touches;
    for (Eigen::Index c = 0; c < point.force.size(); c += 3) touches.push_back(!point.force.segment<3>(c).isZero(0.0));
    samples.in_contact.push_back(std::move(touches));
  }
  return samples;
}

}  // namespace prowl
