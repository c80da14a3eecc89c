#include "prowl/motion/term_evaluation.hpp"

#include <fmt/format.h>

#include "prowl/error.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/robot_frame.hpp"

namespace prowl {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TermEvaluation::TermEvaluation(const RobotModel& robot, const TermUse& use)
    : name_(use.name),
      term_(use.term),
      reads_rates_(prowl::reads_rates(*use.term)),
      kinematics_({}),
      at_rest_(VectorXd::Zero(robot.nv())),
      second_(robot.nv()) {
  std::vector<BodyPoint> points;
  Index size = 0;
  for (const Quantity& quantity : term_->reads()) {
    y_.resize(size);  // where the next entries begin
    if (is_of_frame(quantity.kind)) {
      add_frame(robot, quantity, points);
    } else if (is_of_joints(quantity.kind)) {
      joints_.push_back({size, is_rate(quantity.kind)});
    } else {
      add_center_of_mass(robot, is_rate(quantity.kind), points);
    }
    size += size_of(quantity.kind, robot);
  }
  kinematics_ = PointKinematics(std::move(points));
  const Index rows = term_->num_rows(), nv = robot.nv();
  y_.resize(size);
  y_q_.resize(size, nv);
  y_v_.resize(size, nv);
  value_.resize(rows);
  f_y_.resize(rows, size);
  f_yy_.resize(size, size);
  dq_.resize(rows, nv);
  dv_.setZero(rows, nv);
}

void TermEvaluation::add_frame(const RobotModel& robot, const Quantity& quantity, std::vector<BodyPoint>& points) {
  using Kind = BodyPoint::Kind;
  const RobotFrame frame = robot_frame(robot, quantity.frame);
  const auto add = [&](const Eigen::Vector3d& in_body, Kind kind) {
    sums_.push_back({y_.size(), is_rate(quantity.kind), 3 * std::ssize(points), {1.0}});
    points.push_back({frame.body, in_body, kind});
    y_.resize(y_.size() + 3);
  };
  if (quantity.kind == Quantity::Kind::orientation || quantity.kind == Quantity::Kind::orientation_rate) {
    for (const Index axis : {0, 1, 2}) add(frame.placement.linear().col(axis), Kind::direction);
  } else {
    add(frame.placement.translation(), Kind::point);
  }
}

void TermEvaluation::add_center_of_mass(const RobotModel& robot, bool is_rate, std::vector<BodyPoint>& points) {
  Sum sum{y_.size(), is_rate, 3 * std::ssize(points), {}};
  const std::vector<RigidBody> bodies = body_tree(robot).bodies;
  for (int body = 0; body < static_cast<int>(bodies.size()); ++body) {
    points.push_back({.body = body, .in_body = bodies[body].center});
    sum.weights.push_back(bodies[body].mass / robot.mass());
  }
  sums_.push_back(std::move(sum));
}

void TermEvaluation::check_finite(bool is_finite, const char* what) const {
  if (!is_finite) throw NumericalError(fmt::format("term '{}': {} is not finite", name_, what));
}

void TermEvaluation::evaluate(const RigidBodyTerms& kinematics, const VectorXd& q, const VectorXd& v) {
  kinematics_.set_configuration(kinematics);
  if (reads_rates_) kinematics_.set_motion(at_rest_, v);  // the acceleration of a = v at rest is J v
  for (const Sum& sum : sums_) {
    const VectorXd& of_points = sum.is_rate ? kinematics_.acceleration() : kinematics_.positions();
    Eigen::Vector3d total = Eigen::Vector3d::Zero();
    for (Index i = 0; i < std::ssize(sum.weights); ++i) {
      total += sum.weights[i] * of_points.segment<3>(sum.first + 3 * i);
    }
    y_.segment<3>(sum.entry) = total;
  }
  const Index nu = q.size() - 7;
  for (const Joints& joints : joints_) y_.segment(joints.entry, nu) = (joints.is_rate ? v : q).tail(nu);
  value_.setZero();
  term_->value(y_, value_);
  check_finite(value_.allFinite(), "its value");
}

void TermEvaluation::differentiate() {
  y_q_.setZero();
  if (reads_rates_) {
    y_v_.setZero();
    kinematics_.acceleration_dq(rate_dq_);
  }
  for (const Sum& sum : sums_) {
    const MatrixXd& by_q = sum.is_rate ? rate_dq_ : kinematics_.positions_dq();
    for (Index i = 0; i < std::ssize(sum.weights); ++i) {
      const Index row = sum.first + 3 * i;
      y_q_.middleRows<3>(sum.entry) += sum.weights[i] * by_q.middleRows<3>(row);
      if (sum.is_rate) y_v_.middleRows<3>(sum.entry) += sum.weights[i] * kinematics_.jacobian().middleRows<3>(row);
    }
  }
  const Index nu = y_q_.cols() - 6;
  for (const Joints& joints : joints_) {
    (joints.is_rate ? y_v_ : y_q_).block(joints.entry, 6, nu, nu).setIdentity();
  }
  f_y_.setZero();
  term_->jacobian(y_, f_y_);
  check_finite(f_y_.allFinite(), "its Jacobian");
  dq_.noalias() = f_y_ * y_q_;
  if (reads_rates_) dv_.noalias() = f_y_ * y_v_;
}

void TermEvaluation::add_hessian(const VectorXd& multipliers, Eigen::Ref<MatrixXd> qq, Eigen::Ref<MatrixXd> vq,
                                 Eigen::Ref<MatrixXd> vv) {
  f_yy_.setZero();
  term_->hessian(y_, multipliers, f_yy_);
  check_finite(f_yy_.allFinite(), "its Hessian");
  if (!f_yy_.isZero(0.0)) {
    bent_.noalias() = f_yy_ * y_q_;
    qq.noalias() += y_q_.transpose() * bent_;
    if (reads_rates_) {
      vq.noalias() += y_v_.transpose() * bent_;
      bent_.noalias() = f_yy_ * y_v_;
      vv.noalias() += y_v_.transpose() * bent_;
    }
  }
  if (sums_.empty()) return;
  pull_.noalias() = f_y_.transpose() * multipliers;
  on_position_.setZero(kinematics_.rows());
  on_rate_.setZero(kinematics_.rows());
  for (const Sum& sum : sums_) {
    VectorXd& on_points = sum.is_rate ? on_rate_ : on_position_;
    for (Index i = 0; i < std::ssize(sum.weights); ++i) {
      on_points.segment<3>(sum.first + 3 * i) += sum.weights[i] * pull_.segment<3>(sum.entry);
    }
  }
  kinematics_.add_position_hessian(on_position_, 1.0, qq);
  if (!reads_rates_) return;
  second_.set_zero();
  kinematics_.add_acceleration_hessian(on_rate_, 0.0, second_);
  qq += second_.qq;
  vq += second_.qa.transpose();
}

}  // namespace prowl
