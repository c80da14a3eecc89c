#pragma once

#include <memory>
#include <vector>

#include "alternatives/collocation/dynamics/point_function.hpp"

namespace prowl {

/// Form of the dynamics: which quantities are decision variables, and how the others follow.
class DynamicsForm {
 public:
  virtual ~DynamicsForm() = default;

  /// True: a is a function of the others. False: a variable, with the dynamics as rows.
  virtual bool eliminates_acceleration() const { return false; }
  /// True: contact forces are variables, with J a + J̇ v = 0 as rows. False: recovered.
  virtual bool has_forces() const { return false; }
  /// The dynamics at one instant, with these rows of the node; no dynamics rows if a is eliminated.
  virtual std::unique_ptr<PointFunction> at(ChartedNode& node, const Instant& instant, std::vector<int> rows) const {
    return std::make_unique<PointFunction>(node, instant, std::move(rows));
  }
};

std::unique_ptr<DynamicsForm> inverse_dynamics();
std::unique_ptr<DynamicsForm> forward_dynamics();
std::unique_ptr<DynamicsForm> kkt_dynamics();

}  // namespace prowl
