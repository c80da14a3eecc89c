#pragma once

#include <memory>
#include <vector>

#include "alternatives/collocation/dynamics/point_function.hpp"

namespace prowl {

/// Which quantities of the dynamics are decision variables of a collocation program, and how the others follow from
/// them.
class DynamicsForm {
 public:
  virtual ~DynamicsForm() = default;

  /// a is a function of the others; else a variable, with the dynamics as rows.
  virtual bool eliminates_acceleration() const { return false; }
  /// Contact forces are variables, with J a + J̇ v = 0 as rows; else recovered.
  virtual bool has_forces() const { return false; }
  /// The dynamics at one instant, with these rows of the node. Where a is eliminated, none of them is of the dynamics.
  virtual std::unique_ptr<PointFunction> at(ChartedNode& node, const Instant& instant, std::vector<int> rows) const {
    return std::make_unique<PointFunction>(node, instant, std::move(rows));
  }
};

std::unique_ptr<DynamicsForm> inverse_dynamics();
std::unique_ptr<DynamicsForm> forward_dynamics();
std::unique_ptr<DynamicsForm> kkt_dynamics();

}  // namespace prowl
