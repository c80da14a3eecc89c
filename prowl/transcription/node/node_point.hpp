#pragma once

#include <Eigen/Core>

namespace prowl {

/// Decision variables of one node in its chart (R = chart exp(theta)), and those shared by its
/// phase.
struct NodePoint {
  int node = 0;  ///< within its phase, 0 ... intervals
  Eigen::VectorXd q, v, a, tau;
  Eigen::VectorXd w;  ///< chosen forces of dependent contacts [N]
  Eigen::Vector3d theta;
  double duration = 0.0;         ///< of the phase [s]
  Eigen::VectorXd anchors;       ///< of the contacts of the phase, 3 each, world frame [m]
  double cost_weight = 0.0;      ///< of the running cost: quadrature weight of the node [s], proportional to `duration`
  double terminal_weight = 0.0;  ///< of the terminal cost: 1 at the last node
};

}  // namespace prowl
