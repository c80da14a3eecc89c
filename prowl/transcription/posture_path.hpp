#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/monotone_cubic.hpp"

namespace prowl {

/// The configuration nearest to q that a boundary condition allows.
Eigen::VectorXd meet(const BoundaryCondition& condition, const Eigen::VectorXd& q);

/// Time of a boundary condition on the mesh [s].
double time_of(const BoundaryCondition& condition, const Mesh& mesh);

/// What the boundary conditions alone say about the motion: base and joints, contacts not considered. Each coordinate
/// of base position and joints has its own waypoints, so that one that is free at a condition goes on to the next; the
/// base's rotation turns from one prescribed rotation to the next about a fixed axis, at rest at both.
class PosturePath {
 public:
  PosturePath(const MotionProblem& problem, const Mesh& mesh);

  /// Configuration (nq) at a time [s].
  Eigen::VectorXd operator()(double time) const;

 private:
  struct Turn {
    double time;
    Eigen::Quaterniond rotation;
  };

  void add(const BoundaryCondition& condition, const Eigen::VectorXd& q, double time,
           std::vector<std::vector<Waypoint>>& waypoints);
  Eigen::Quaterniond rotation(double time) const;

  std::vector<MonotoneCubic> curves_;
  std::vector<Turn> turns_;
};

}  // namespace prowl
