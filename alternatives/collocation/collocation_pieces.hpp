#pragma once

#include "alternatives/collocation/collocation.hpp"
#include "alternatives/collocation/graph/rate_function.hpp"

namespace prowl {

/// Functions of one node.
struct Collocation::NodePiece {
  ProgramPiece piece;
  PointFunction* dynamics = nullptr;
  ProgramGraph::Vector acceleration = {};
  Eigen::MatrixXd hessian = {};
  std::vector<HessianEntry> entries = {};
};

/// Functions of one interval. Accelerations at its ends, if functions, come from the node pieces.
struct Collocation::IntervalPiece {
  ProgramPiece piece;
  struct Link {
    ProgramGraph::Vector here, there;
    int node = 0;
    std::vector<int> columns;  ///< local variable of this piece for each local of the node's
  };
  std::vector<Link> links = {};
  Eigen::MatrixXd hessian = {};
  std::vector<HessianEntry> entries = {};
};

}  // namespace prowl
