#pragma once

#include <string>
#include <vector>

#include "arrays.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl::python {

/// A trajectory as arrays, one row per point.
struct Motion {
  explicit Motion(const Trajectory& trajectory);
  Trajectory trajectory() const;

  Eigen::VectorXd t;
  Eigen::VectorXi phase;
  RowMatrix q, v, a, tau, f;
};

}  // namespace prowl::python
