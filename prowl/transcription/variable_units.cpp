#include "prowl/transcription/variable_units.hpp"

#include <cmath>

namespace prowl {

VariableUnits::VariableUnits(const RobotModel& robot)
    : length(robot.size()),
      time(std::sqrt(length / RobotModel::kGravity)),
      force(robot.weight()),
      q(Eigen::VectorXd::Ones(robot.nv())),
      tau(Eigen::VectorXd::Constant(robot.nu(), force * length)) {
  q.head<3>().setConstant(length);
  for (int i = 0; i < robot.nu(); ++i) {
    if (!robot.joint_is_prismatic()[i]) continue;
    q(6 + i) = length;
    tau(i) = force;
  }
}

}  // namespace prowl
