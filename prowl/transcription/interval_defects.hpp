#pragma once

#include <Eigen/Core>

#include "prowl/transcription/base_defects.hpp"

namespace prowl {

/// One end of a mesh interval: chart and decision variables.
struct IntervalEnd {
  Eigen::Matrix3d chart;
  Eigen::VectorXd q, v, a;  ///< nv each; q = (base position, theta, joints)

  BaseState base() const { return {chart, q.segment<3>(0), q.segment<3>(3), v.segment<3>(0), v.segment<3>(3)}; }
};

/// Defects of the trapezoid over one interval of length h [s]: (q, nv rows | v, nv rows).
///
///   joints   q1 - q0 - h/2 (v0 + v1),   v1 - v0 - h/2 (a0 + a1),   the base as in BaseDefects
class IntervalDefects {
 public:
  /// `correction`: what the rule adds to the step (2 nv, a row of Corrections); empty: nothing.
  IntervalDefects(IntervalEnd start, IntervalEnd end, double h, const Eigen::VectorXd& correction = {});

  Eigen::VectorXd value() const;
  Eigen::VectorXd d_step() const;  ///< derivative in h

  /// Derivatives of the base defects at an end (0 or 1).
  Eigen::Matrix3d position_dtheta(int end) const;
  Eigen::Matrix3d position_dv(int end) const;
  BaseDefects::Matrix3x12 rotation_derivative() const { return base_.rotation_derivative(); }

  /// Second derivatives of multipliers . value by blocks: at each end, between the ends, with the
  /// step.
  struct Hessian {
    Eigen::Matrix3d theta_v[2];           ///< (theta, linear velocity) at an end
    Eigen::Matrix<double, 6, 6> turn[2];  ///< (theta, angular velocity) at an end
    Eigen::Matrix<double, 6, 6> link;     ///< the same, end x start
    Eigen::VectorXd step[2];              ///< step with (q | v | a) of an end
    double step_step = 0.0;
  };
  Hessian hessian(const Eigen::VectorXd& multipliers) const;

 private:
  const IntervalEnd& at(int end) const { return end == 0 ? start_ : end_; }

  IntervalEnd start_, end_;
  double h_;
  Eigen::VectorXd correction_;
  Eigen::Index nv_, nu_;
  BaseDefects base_;
};

}  // namespace prowl
