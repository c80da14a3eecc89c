#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "prowl/dynamics/point_kinematics.hpp"
#include "prowl/motion/term_use.hpp"

namespace prowl {

/// A term at one node: value and derivatives in q and v, by the chain rule through the kinematics:
///
///   df = f_y Y,   d²(lambda . f) = Yᵀ (lambda . f_yy) Y + (lambda . f_y) . Y',   Y = dy / d(q, v)
///
/// One object holds the work space of one thread; results stay until the next evaluation.
class TermEvaluation {
 public:
  TermEvaluation(const RobotModel& robot, const TermUse& use);

  /// `kinematics`: at the configuration q. Throws NumericalError, with the name of the use, if f is not finite.
  void evaluate(const RigidBodyTerms& kinematics, const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  const Eigen::VectorXd& value() const { return value_; }

  /// After evaluate(). Throws likewise.
  void differentiate();
  const Eigen::MatrixXd& dq() const { return dq_; }  ///< in the tangent of configuration.hpp
  const Eigen::MatrixXd& dv() const { return dv_; }
  bool reads_rates() const { return reads_rates_; }  ///< otherwise dv() is zero

  /// After differentiate(): adds the second derivatives of multipliers . f; vq has one row for each velocity.
  void add_hessian(const Eigen::VectorXd& multipliers, Eigen::Ref<Eigen::MatrixXd> qq, Eigen::Ref<Eigen::MatrixXd> vq,
                   Eigen::Ref<Eigen::MatrixXd> vv);

 private:
  /// Three entries of y: a weighted sum of points, or its rate.
  struct Sum {
    Eigen::Index entry;
    bool is_rate;
    Eigen::Index first;           ///< row of its first point
    std::vector<double> weights;  ///< of the points
  };
  /// nu entries of y.
  struct Joints {
    Eigen::Index entry;
    bool is_rate;
  };

  void add_frame(const RobotModel& robot, const Quantity& quantity, std::vector<BodyPoint>& points);
  void add_center_of_mass(const RobotModel& robot, bool is_rate, std::vector<BodyPoint>& points);
  void check_finite(bool is_finite, const char* what) const;

  std::string name_;
  std::shared_ptr<const Term> term_;
  bool reads_rates_;
  std::vector<Sum> sums_;
  std::vector<Joints> joints_;
  PointKinematics kinematics_;
  // Work space.
  Eigen::VectorXd at_rest_, y_, value_, pull_, on_position_, on_rate_;
  Eigen::MatrixXd y_q_, y_v_, rate_dq_, f_y_, f_yy_, bent_, dq_, dv_;
  SecondDerivatives second_;
};

}  // namespace prowl
