#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl::test {

/// Constrained dynamics by another way than Prowl's, as the reference: the terms straight from Pinocchio (CRBA, frame
/// Jacobians and accelerations), the accelerations from an orthonormal basis N of the null space of J by an SVD,
///   a = −J⁺ J̇ v + N y,   N' M N y = N' (S' τ − h + M J⁺ J̇ v).
class NullSpaceDynamics {
 public:
  NullSpaceDynamics(const RobotModel& robot, std::vector<int> contacts);
  ~NullSpaceDynamics();

  /// Sets J and what follows from it.
  void set_configuration(const Eigen::VectorXd& q);
  /// a at the last configuration; sets M, applied and J_dot_v.
  Eigen::VectorXd solve(const Eigen::VectorXd& v, const Eigen::VectorXd& tau);

  Eigen::MatrixXd J, pseudo_inverse, N;
  int rank = 0;
  double J_norm = 0.0, singular_value_ratio = 1.0;  ///< largest singular value; smallest over largest that count
  Eigen::MatrixXd M;
  Eigen::VectorXd applied, J_dot_v;  ///< S' τ − h; J̇ v

 private:
  struct Workspace;  // Pinocchio's
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace prowl::test
