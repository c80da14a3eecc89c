#include "prowl/terms/selected_entries.hpp"

#include "prowl/error.hpp"

namespace prowl {

namespace {

std::shared_ptr<const Term> of_joints(Quantity::Kind kind, const RobotModel& robot, const std::vector<int>& joints,
                                      std::string unit) {
  std::vector<std::string> names;
  for (const int joint : joints) {
    if (joint < 0 || joint >= robot.nu() || robot.joint_is_prismatic()[joint]) {
      throw InputError("joint " + std::to_string(joint) + " is not allowed; need the index of one that turns");
    }
    names.push_back(robot.joint_names()[joint]);
  }
  return std::make_shared<SelectedEntries>(Quantity{.kind = kind}, joints, std::move(names), std::move(unit));
}

}  // namespace

std::shared_ptr<const Term> joint_positions(const RobotModel& robot, const std::vector<int>& joints) {
  return of_joints(Quantity::Kind::joints, robot, joints, "rad");
}

std::shared_ptr<const Term> joint_rates(const RobotModel& robot, const std::vector<int>& joints) {
  return of_joints(Quantity::Kind::joint_rates, robot, joints, "rad/s");
}

std::shared_ptr<const Term> joint_torques(const RobotModel& robot, const std::vector<int>& joints) {
  return of_joints(Quantity::Kind::torques, robot, joints, "N m");
}

}  // namespace prowl
