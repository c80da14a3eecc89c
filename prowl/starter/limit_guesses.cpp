#include "prowl/starter/limit_guesses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "prowl/error.hpp"
#include "prowl/model/robot_inspection.hpp"
#include "prowl/starter/rounding.hpp"

namespace prowl {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;  // [rad]; a range beyond this limits nothing
constexpr double kStraight = 0.1, kMostBent = 2.6;    // [rad], of a knee
constexpr double kSwing = 1.5;                        // [rad], of other joints of legs, either way
constexpr double kVelocity = 10.0;                    // [rad/s]
constexpr double kTorqueOfStanding = 5.0;

double two_digits(double x) {
  if (!(x > 0.0)) return 1.0;
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return unit * std::ceil(x / unit);
}

std::pair<double, double> range_of(int joint, const Knee* knee, const StandingPosture& posture) {
  const double now = posture.joints(joint);
  if (knee == nullptr) return {hundredths(now - kSwing), hundredths(now + kSwing)};
  const double side = now > knee->straight ? 1.0 : -1.0;
  const double near = knee->straight + side * kStraight, far = knee->straight + side * kMostBent;
  return {hundredths(std::min(near, far)), hundredths(std::max(near, far))};
}

}  // namespace

std::map<std::string, JointLimits> usable_limits(const UrdfOutline& outline) {
  std::map<std::string, JointLimits> limits;
  for (const UrdfOutline::Limits& joint : outline.joints) {
    JointLimits usable;
    if (joint.prismatic && (!joint.has_range() || !(joint.velocity > 0.0))) {
      throw InputError(
          fmt::format("joint '{}' slides, but the URDF lacks its range [m] or velocity [m/s], and Prowl cannot "
                      "guess them: put lower, upper and velocity into its <limit>",
                      joint.joint));
    }
    if (!joint.has_range()) {
      usable.position_lower = -std::numbers::pi;
      usable.position_upper = std::numbers::pi;
    }
    if (!(joint.velocity > 0.0)) usable.velocity = kVelocity;
    if (!(joint.effort > 0.0)) usable.torque = kNoRealLimit;
    if (usable.position_lower || usable.velocity || usable.torque) limits[joint.joint] = usable;
  }
  return limits;
}

std::vector<LimitGuess> guess_limits(const RobotModel& robot, const UrdfOutline& outline, const std::vector<Leg>& legs,
                                     const StandingPosture& posture, const Eigen::VectorXd& standing_torque) {
  std::vector<LimitGuess> guesses;
  const double all_legs = std::max(1e-2, standing_torque.cwiseAbs().maxCoeff());
  for (int j = 0; j < robot.nu(); ++j) {
    const std::string& name = robot.joint_names()[j];
    const auto found = std::find_if(outline.joints.begin(), outline.joints.end(),
                                    [&](const auto& joint) { return joint.joint == name; });
    if (found == outline.joints.end()) continue;
    bool in_leg = false;
    const Knee* knee = nullptr;
    for (std::size_t l = 0; l < legs.size(); ++l) {
      in_leg = in_leg || std::find(legs[l].joints.begin(), legs[l].joints.end(), j) != legs[l].joints.end();
      if (posture.knees[l].joint == j) knee = &posture.knees[l];
    }
    LimitGuess guess{.joint = name, .position = {}, .velocity = {}, .torque = {}};
    guess.is_knee = knee != nullptr;
    const bool is_endless = in_leg && !found->prismatic && (found->lower < -kFullTurn || found->upper > kFullTurn);
    if (!found->has_range() || is_endless) guess.position = range_of(j, knee, posture);
    if (!(found->velocity > 0.0)) guess.velocity = kVelocity;
    if (!(found->effort > 0.0))
      guess.torque = two_digits(kTorqueOfStanding * (in_leg ? all_legs : std::abs(standing_torque(j))));
    guess.torque_is_no_limit = found->effort >= kNoRealLimit;
    if (guess.position || guess.velocity || guess.torque || guess.torque_is_no_limit) guesses.push_back(guess);
  }
  return guesses;
}

}  // namespace prowl
