#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "prowl/guess/monotone_cubic.hpp"
#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// The configuration nearest to q that a boundary constraint allows.
Eigen::VectorXd meet(const BoundaryConstraint& constraint, const Eigen::VectorXd& q);

/// Motion of base and joints from the boundary constraints alone, without contacts. Each coordinate of base position
/// and joints has its own waypoints; one that is free at a condition continues to the next. The base turns from one
/// prescribed rotation to the next about a fixed axis, at rest at both. With a reference, the motion is that instead.
class PosturePath {
 public:
  explicit PosturePath(const DiscreteProblem& discrete);

  /// Configuration (nq) at a time [s].
  Eigen::VectorXd operator()(double time) const;

 private:
  struct Turn {
    double time;
    Eigen::Quaterniond rotation;
  };

  void add(const BoundaryConstraint& constraint, const Eigen::VectorXd& q, double time,
           std::vector<std::vector<Waypoint>>& waypoints);
  void add_cycle(const DiscreteProblem& discrete, std::vector<std::vector<Waypoint>>& waypoints);
  Eigen::Quaterniond rotation(double time) const;

  std::vector<MonotoneCubic> curves_;
  std::vector<Turn> turns_;
  std::shared_ptr<const ReferenceMotion> reference_;  // null without one
};

}  // namespace prowl
