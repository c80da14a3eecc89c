#pragma once

#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

enum class NewTaskKind { hold, stand, crouch, step, gait };

/// A motion sized for one robot. Lengths in [m].
struct NewTask {
  NewTaskKind kind = NewTaskKind::crouch;
  bool soles = false;                               ///< feet of several contacts
  double height = 0.0;                              ///< of the base in the nominal posture, over the ground
  double depth = 0.0;                               ///< crouch: how far down
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< stand: of the base
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();   ///< stand: base_rpy_rad
  std::vector<std::string> swing;                   ///< step: contacts of the foot that steps
  std::vector<std::string> stay;                    ///< step: the others
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< step: where the first of `swing` lands
  double length = 0.0;                              ///< step
  std::string pattern;                              ///< gait: its name, as in gait_patterns()
  double stride_duration = 0.0;                     ///< gait [s]
  double stride_length = 0.0;                       ///< gait
  double duty_factor = 0.0;                         ///< gait; 0: the usual one of its pattern
  double intervals_per_second = 0.0;                ///< gait
  double torque_weight = 0.0;
};

/// What new_task() knows: "hold", "stand", "crouch", "step", and every gait of gait_patterns().
std::vector<std::string> new_task_kinds();

/// Sizes: a share of the standing height, made smaller until inverse kinematics finds a posture within the limits, well
/// inside them, whose torques at rest the joints can give. Throws InputError for a robot that cannot stand still on its
/// contacts, or cannot do such a motion at any size. Gaits are scaled with the height alone (equal Froude numbers) and
/// need four feet. `kind`: one of new_task_kinds().
NewTask new_task(const RobotModel& robot, const std::string& kind);

/// The task file, each part of it explained. `robot_file`: what it is to say for its robot, `name`: of the motion.
std::string task_template(const NewTask& task, const RobotModel& robot, const std::string& robot_file);

std::string kind_name(const NewTask& task);  ///< "hold", "trot" ...

/// How the tasks of a gait do, unedited, on HyQ, ANYmal C, Go2, Solo12, B1 and A1.
enum class GaitEvidence {
  all,      ///< all pass; so do the motions that are no gaits
  refined,  ///< all pass on a refined mesh
  some,     ///< three pass on a refined mesh
};

GaitEvidence gait_evidence(const std::string& pattern);

}  // namespace prowl
