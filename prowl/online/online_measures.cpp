#include "prowl/online/online_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prowl/model/configuration.hpp"

namespace prowl {
namespace {

/// A fall: the base lower than this share of its standing height, or tilted by this [rad].
constexpr double kFallHeight = 2.0 / 3.0, kFallTilt = 0.7;
constexpr double kMostLastVelocity = 0.1;  ///< [m/s], at success
constexpr double kLastSecond = 1.0;        ///< [s]
constexpr double kMostOutside = 0.01;      ///< of the weight, of forces that count as within their cones

/// Velocity of the base ahead and to the left of its heading, and its turn rate.
Eigen::Vector3d moves_of(const Physics& physics) {
  const Eigen::Matrix3d rotation = base_rotation(physics.q());
  const double yaw = heading(physics.q()), c = std::cos(yaw), s = std::sin(yaw);
  const Eigen::Vector3d velocity = rotation * physics.v().head<3>();
  return {c * velocity.x() + s * velocity.y(), c * velocity.y() - s * velocity.x(),
          (rotation * physics.v().segment<3>(3)).z()};
}

}  // namespace

OnlineMeasures::OnlineMeasures(const RobotModel& robot, const std::vector<std::vector<int>>& feet, double friction,
                               double duration, double standing_height)
    : duration_(duration), standing_height_(standing_height), forces_(robot, feet, friction) {}

bool OnlineMeasures::add_state(double t, const Physics& physics, const MpcCommand& command, const Surface& ground) {
  const Eigen::Vector3d off = moves_of(physics) - Eigen::Vector3d(command.forward, command.left, command.turn);
  velocity_squares_ += off.head<2>().squaredNorm();
  turn_squares_ += off.z() * off.z();
  ++measured_;
  if (t >= duration_ - kLastSecond) {
    last_off_ += off.head<2>();
    ++last_count_;
  }
  const double above = ground.normal.dot(physics.q().head<3>() - ground.point);
  const double tilt = std::acos(std::clamp(base_rotation(physics.q())(2, 2), -1.0, 1.0));
  return above >= kFallHeight * standing_height_ && tilt <= kFallTilt;
}

void OnlineMeasures::add_plan(const MpcPlan& plan, double period, bool pushed) {
  ForceCount& count = pushed ? kicked_ : undisturbed_;
  ++count.plans;
  if (forces_.outside(plan, plan.start() + 0.5 * period) > kMostOutside) ++count.outside;
}

OnlineSample OnlineMeasures::sample(double t, const Physics& physics, const MpcCommand& command) {
  OnlineSample sample{.time = t,
                      .q = physics.q(),
                      .v = physics.v(),
                      .force = Eigen::VectorXd::Zero(3 * std::ssize(physics.contacts())),
                      .moves = moves_of(physics),
                      .commanded = {command.forward, command.left, command.turn}};
  for (std::size_t c = 0; c < physics.contacts().size(); ++c)
    sample.force.segment<3>(3 * static_cast<Eigen::Index>(c)) = physics.contacts()[c].force;
  return sample;
}

void OnlineMeasures::finish(OnlineResult& result) const {
  const auto mean = [&](double squares) {
    return measured_ > 0 ? std::sqrt(squares / static_cast<double>(measured_)) : 0.0;
  };
  result.velocity_error = mean(velocity_squares_);
  result.turn_error = mean(turn_squares_);
  if (last_count_ > 0 && result.end == OnlineResult::End::finished)
    result.last_velocity = (last_off_ / static_cast<double>(last_count_)).norm();
  result.undisturbed = undisturbed_;
  result.kicked = kicked_;
  result.touches.assign(touches_.begin(), touches_.end());
  if (result.end == OnlineResult::End::fell) {
    result.failures = {fmt::format("fell at {:.2f} s", result.end_time)};
    return;
  }
  if (result.end == OnlineResult::End::diverged) {
    result.failures = {fmt::format("the simulation diverged at {:.2f} s", result.end_time)};
    return;
  }
  if (result.counters.updates > 0 && result.counters.failed == result.counters.updates)
    result.failures.push_back(fmt::format("no plan: {} updates failed", result.counters.failed));
  for (const std::string& touch : result.touches) result.failures.push_back("touched: " + touch);
  if (result.last_velocity && *result.last_velocity > kMostLastVelocity)
    result.failures.push_back(fmt::format("mean velocity of the last second {:.2f} m/s off the command; {:g} allowed",
                                          *result.last_velocity, kMostLastVelocity));
}

}  // namespace prowl
