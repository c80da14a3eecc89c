#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

/// A constant force on the base's centre of mass during `duration`.
struct Push {
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< world frame [N s]
  double time = 0.0;                                  ///< start [s]
  double duration = 0.1;                              ///< [s]
};

/// Throws InputError unless all begin at 0 s or later, last more than 0 s, and are finite.
void check_pushes(const std::vector<Push>& pushes);

/// Force of all pushes at time t [s], world frame [N].
Eigen::Vector3d push_at(const std::vector<Push>& pushes, double t);

}  // namespace prowl
