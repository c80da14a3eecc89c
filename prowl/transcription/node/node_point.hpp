#pragma once

#include <Eigen/Core>

namespace prowl {

/// The decision variables of one node, in their own chart (R = chart exp(theta)), and what its phase shares.
struct NodePoint {
  int node = 0;  ///< within its phase, 0 ... intervals
  Eigen::VectorXd q, v, a, tau;
  Eigen::VectorXd w;  ///< forces of the rows of dependent contacts that are chosen [N]
  Eigen::Vector3d theta;
  double duration = 0.0;         ///< of the phase [s]
  Eigen::VectorXd anchors;       ///< place of each contact of the phase, 3 rows each, world frame [m]
  double cost_weight = 0.0;      ///< of the running cost: the node's share of the time [s], in proportion to `duration`
  double terminal_weight = 0.0;  ///< of the terminal cost: 1 at the last node
};

}  // namespace prowl
