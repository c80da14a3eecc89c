#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// What files write that know no limit, or more [N m, N, rad/s, m/s, m].
constexpr double kNoRealLimit = 1000.0;

/// Something about a robot that can be planned with, but is probably not meant.
struct RobotWarning {
  enum class Kind {
    inertia,   ///< a link whose mass or inertia no real body has, or next to no mass
    limit,     ///< a limit that limits nothing
    ground,    ///< contacts not level in the nominal posture
    symmetry,  ///< left and right differ
    contacts,  ///< two at one point, or the rank of the contact Jacobian hangs on the threshold
    posture,   ///< nominal posture outside the joint limits
    size       ///< millimetres or grams, as it seems
  };
  Kind kind;
  std::string text;  ///< one sentence, with names, values and units
};

/// What `prowl robot` tells beyond names and limits.
struct RobotInspection {
  std::vector<RobotWarning> warnings;
  /// Of the contact Jacobian J in the nominal posture (all contacts, 3 rows each, world axes), largest first;
  /// min(rows, nv) of them.
  Eigen::VectorXd contact_singular_values;
  int contact_rows = 0;
  int contact_rank = 0;  ///< singular values above 1e-8 of the largest; less than the rows: redundant contacts
};

RobotInspection inspect(const RobotModel& robot);

/// Of those the ones of kind size, as text: a robot in other units than metres and kilograms.
std::vector<std::string> implausible_sizes(const RobotModel& robot);

/// What a contact may be fixed to: the links and fixed joints of the URDF.
std::vector<std::string> contact_frame_names(const RobotModel& robot);

}  // namespace prowl
