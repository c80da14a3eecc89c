#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "alternatives/centroidal/centroidal_node.hpp"
#include "prowl/transcription/interval_defects.hpp"

namespace prowl {

/// From one node to the next over a step dt, as Dai, Valenzuela, Tedrake 2014, eq. (7d) to (7g), have it: q, h and r'
/// by backward Euler, r by the trapezoid. On SE(3) backward Euler is
///
///   p1 - p0 - dt R1 v1 = 0,   log( R0' R1 exp(-dt w1) ) = 0,   joints1 - joints0 - dt rates1 = 0
///
/// which is the trapezoid over 2 dt from a start at rest, by whose derivatives it goes. Also here: contacts do not
/// slide, and the cost of the accelerations that the steps of v mean, for all but the base's linear one.
class CentroidalInterval {
 public:
  struct End {
    const CentroidalColumns& columns;
    Eigen::Matrix3d chart;
    Eigen::VectorXd x;
  };
  /// `weight` of accelerations, nv; the first three do not count. What is given must live as long as this.
  CentroidalInterval(const CentroidalScale& scale, const std::vector<HeldDirection>& sliding,
                     const Eigen::VectorXd& weight, End start, End end, double step);

  static int num_rows(int nv, int sliding) { return nv + 9 + sliding; }
  static std::vector<RowGroup> row_groups(int nv, int sliding);

  Eigen::VectorXd rows() const;
  /// Derivatives in x of the start (columns from `start`) and of the end; and in the step, per unit of a variable
  /// `duration` of which the step is a share, or none if that is negative.
  void add_jacobian(int row, int start, int end, int duration, double share, SparseEntries& jacobian) const;

  double cost() const;
  /// Adds the gradient in x of both ends and in the step.
  void add_cost_gradient(Eigen::Ref<Eigen::VectorXd> start, Eigen::Ref<Eigen::VectorXd> end, double& step) const;

  /// Adds the Hessian of cost_factor * cost + multipliers . rows to that of both ends (with the duration as their last
  /// variable) and gives what is between them.
  struct Between {
    Eigen::Matrix<double, 6, 3> turn;  ///< (theta, angular velocity) of the end, theta of the start
    Eigen::VectorXd v;                 ///< v of the end with the same entry of v of the start; from entry 3 on
  };
  Between add_hessian(double cost_factor, const Eigen::VectorXd& multipliers, double share, Eigen::MatrixXd& start,
                      Eigen::MatrixXd& end) const;

 private:
  Eigen::Vector3d of(const End& end, int column) const { return end.x.segment<3>(column); }

  const CentroidalScale& scale_;
  const std::vector<HeldDirection>& sliding_;
  const Eigen::VectorXd& weight_;
  End start_, end_;
  double step_;
  int nv_;
  Eigen::VectorXd change_;  ///< v1 - v0, what does not count set to zero
  IntervalDefects euler_;
};

}  // namespace prowl
