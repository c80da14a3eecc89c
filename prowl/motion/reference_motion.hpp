#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/motion/term_use.hpp"

namespace prowl {

/// Postures over time that a motion should follow.
struct ReferenceMotion {
  Eigen::VectorXd times;  ///< ascending [s], one or more
  Eigen::MatrixXd q;      ///< nq x times

  /// Posture at a time [s]: linear between the times, the base along the shortest turn; constant outside.
  Eigen::VectorXd at(double time) const;
};

/// Weights of the cost of deviations from a reference, all >= 0.
struct ReferenceWeights {
  Eigen::Vector3d base_position = Eigen::Vector3d::Zero();  ///< world x y z [1/m²]
  double base_orientation = 0.0;                            ///< [1/rad²]
  Eigen::VectorXd joint_position;                           ///< nu [1/rad²]

  struct Frame {
    std::string name;     ///< link of the URDF
    double weight = 0.0;  ///< on the position of its origin [1/m²]
  };
  std::vector<Frame> frames = {};
};

/// Costs of deviations over the whole motion, with names that begin with "reference". Half of the weight times the
/// squared deviation, integrated over time; for the base's orientation its square is 2 - 2 cos(angle). Throws
/// InputError for an unknown frame.
std::vector<TermUse> reference_costs(const RobotModel& robot, const ReferenceMotion& reference,
                                     const ReferenceWeights& weights, int num_phases);

}  // namespace prowl
