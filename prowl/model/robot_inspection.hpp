#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Files without a real limit contain this, or more [N m, N, rad/s, m/s, m].
constexpr double kNoRealLimit = 1000.0;

/// A property of a robot that planning allows, but that is probably a mistake.
struct RobotWarning {
  enum class Kind {
    inertia,   ///< a link with impossible mass or inertia, or almost no mass
    limit,     ///< a limit that limits nothing
    mimic,     ///< a joint that copies another, and is locked
    ground,    ///< contacts not level in the nominal posture
    symmetry,  ///< left and right differ
    contacts,  ///< two at one point, or an ambiguous rank of the contact Jacobian
    posture,   ///< nominal posture outside the joint limits
    size       ///< probably in millimetres or grams
  };
  Kind kind;
  std::string text;  ///< one sentence, with names, values and units
};

/// Content of `prowl robot` beyond names and limits.
struct RobotInspection {
  std::vector<RobotWarning> warnings;
  /// For the nominal posture (all contacts, 3 rows each, world axes); min(rows, nv) values, largest first.
  Eigen::VectorXd contact_singular_values;
  int contact_rows = 0;
  int contact_rank = 0;  ///< singular values above 1e-8 of the largest; below contact_rows: redundant contacts
};

RobotInspection inspect(const RobotModel& robot);

/// The warnings of kind size, as text: a robot in other units than metres and kilograms.
std::vector<std::string> implausible_sizes(const RobotModel& robot);

/// Frames that a contact may be fixed to: links and fixed joints of the URDF.
std::vector<std::string> contact_frame_names(const RobotModel& robot);

}  // namespace prowl
