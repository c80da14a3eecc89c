#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "alternatives/centroidal/centroidal_node.hpp"
#include "prowl/transcription/interval_defects.hpp"

namespace prowl {

/// Rows of one interval of length dt, Dai, Valenzuela, Tedrake 2014, eq. (7d) to (7g): q, h and r'
/// by backward Euler, r by the trapezoid. On SE(3) backward Euler is
///
///   p1 - p0 - dt R1 v1 = 0,   log( R0' R1 exp(-dt w1) ) = 0,   joints1 - joints0 - dt rates1 = 0
///
/// This equals the trapezoid over 2 dt from rest, whose derivatives it uses. Also: contacts do not
/// slide, and the cost of accelerations (differences of v) except the base's linear one.
class CentroidalInterval {
 public:
  struct End {
    const CentroidalColumns& columns;
    Eigen::Matrix3d chart;
    Eigen::VectorXd x;
  };
  /// `weight`: of accelerations (nv), the first three unused. All referenced arguments must outlive
  /// this.
  CentroidalInterval(const CentroidalScale& scale, const std::vector<HeldDirection>& sliding,
                     const Eigen::VectorXd& weight, End start, End end, double step);

  static int num_rows(int nv, int sliding) { return nv + 9 + sliding; }
  static std::vector<RowGroup> row_groups(int nv, int sliding);

  Eigen::VectorXd rows() const;
  /// Adds derivatives in x of the start (columns from `start`) and of the end, and in the variable
  /// `duration` (none if negative), of which the step is the part `share`.
  void add_jacobian(int row, int start, int end, int duration, double share, SparseEntries& jacobian) const;

  double cost() const;
  /// Adds the gradient in x of both ends and in the step.
  void add_cost_gradient(Eigen::Ref<Eigen::VectorXd> start, Eigen::Ref<Eigen::VectorXd> end, double& step) const;

  /// Adds the Hessian of cost_factor * cost + multipliers . rows to the blocks of both ends
  /// (duration last) and returns the blocks between them.
  struct Between {
    Eigen::Matrix<double, 6, 3> turn;  ///< (theta, angular velocity) of the end, theta of the start
    Eigen::VectorXd v;                 ///< v of the end with the same entry of v of the start, from entry 3
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
  Eigen::VectorXd change_;  ///< v1 - v0, unused entries zero
  IntervalDefects euler_;
};

}  // namespace prowl
