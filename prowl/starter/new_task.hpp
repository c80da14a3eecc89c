#pragma once

#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

enum class NewTaskKind { hold, stand, crouch, step, gait };

/// A motion sized for one robot. Lengths in [m].
struct NewTask {
  NewTaskKind kind = NewTaskKind::crouch;
  bool soles = false;                                  ///< feet have several contacts
  double height = 0.0;                                 ///< of the base above the ground, nominal posture
  double depth = 0.0;                                  ///< crouch: depth
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();     ///< stand: of the base
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();      ///< stand: base_rpy_rad
  std::vector<std::string> swing;                      ///< step: contacts of the stepping foot
  std::vector<std::string> stay;                       ///< step: the others
  Eigen::Vector3d foothold = Eigen::Vector3d::Zero();  ///< step: foothold of the first of `swing`, world frame
  double length = 0.0;                                 ///< step: length
  std::string pattern;                                 ///< gait: its name, as in gait_patterns()
  double speed = 0.0;                                  ///< gait [m/s]
  double torque_weight = 0.0;
};

/// Kinds for new_task(): "hold", "stand", "crouch", "step", and every gait of gait_patterns().
std::vector<std::string> new_task_kinds();

/// Sizes a motion of `kind` (see new_task_kinds()): a share of the standing height, reduced until
/// inverse kinematics finds a posture well inside the position and torque limits. Gaits scale with
/// the height alone (equal Froude numbers) and need four feet. Throws InputError if the robot
/// cannot stand still on its contacts, or cannot perform the motion at any size.
NewTask new_task(const RobotModel& robot, const std::string& kind);

/// Text of the task file, with comments. `robot_file`: value of its key `robot`.
std::string task_template(const NewTask& task, const RobotModel& robot, const std::string& robot_file);

std::string kind_name(const NewTask& task);  ///< "hold", "trot" ...

}  // namespace prowl
