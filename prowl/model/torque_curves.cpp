#include <fmt/format.h>

#include <algorithm>

#include "prowl/model/description_error.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

void RobotModel::add_torque_curve(const std::string& name, int joint, const LimitCurve::Table& table,
                                  bool over_velocity) {
  if (table.empty()) return;
  try {
    torque_curves_.push_back({joint, over_velocity, LimitCurve(table)});
  } catch (const InputError& error) {
    throw DescriptionError("limits." + name, fmt::format("limits.{}.torque_over_{}: {}", name,
                                                         over_velocity ? "velocity" : "position", error.what()));
  }
}

/// A curve has to cover where the joint can be: beyond its table it is a guess.
void RobotModel::check_torque_curves() const {
  for (const TorqueCurve& limit : torque_curves_) {
    const double lower = limit.over_velocity ? -velocity_limit_(limit.joint) : position_lower_(limit.joint);
    const double upper = limit.over_velocity ? velocity_limit_(limit.joint) : position_upper_(limit.joint);
    if (limit.curve.lower_end() <= lower && limit.curve.upper_end() >= upper) continue;
    const std::string& name = joint_names_[limit.joint];
    throw DescriptionError(
        "limits." + name,
        fmt::format("limits.{}.torque_over_{}: a table from {:g} to {:g} is not allowed; it has to cover the "
                    "joint's range, {:g} to {:g}",
                    name, limit.over_velocity ? "velocity" : "position", limit.curve.lower_end(),
                    limit.curve.upper_end(), lower, upper));
  }
}

double RobotModel::torque_upper(int joint, double position, double velocity) const {
  double limit = torque_limit_(joint);
  for (const TorqueCurve& curve : torque_curves_) {
    if (curve.joint == joint) limit = std::min(limit, curve.curve.value(curve.over_velocity ? velocity : position));
  }
  return limit;
}

double RobotModel::torque_lower(int joint, double position, double velocity) const {
  return -torque_upper(joint, position, -velocity);
}

}  // namespace prowl
