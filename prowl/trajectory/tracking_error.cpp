#include "prowl/trajectory/tracking_error.hpp"

#include <cmath>

#include "prowl/model/configuration.hpp"

namespace prowl {

void ErrorSum::add(double value, bool at_rest) {
  if (!(value <= largest_)) largest_ = value;  // keeps NaN
  squares_ += value * value;
  ++count_;
  if (at_rest && !(value <= rest_)) rest_ = value;
}

ErrorMeasure ErrorSum::measure() const {
  return {largest_, count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0, rest_};
}

void TrackingError::add(const Eigen::VectorXd& q_ref, const Eigen::VectorXd& q, bool at_rest) {
  const Eigen::VectorXd error = difference(q_ref, q);
  const Eigen::Index joints = error.size() - 6;
  position_.add(error.head<3>().norm(), at_rest);
  angle_.add(error.segment<3>(3).norm(), at_rest);
  worst_joint_.add(error.tail(joints).lpNorm<Eigen::Infinity>(), at_rest);
  joints_.add(error.tail(joints).norm() / std::sqrt(static_cast<double>(joints)), at_rest);
}

ErrorMeasure TrackingError::joints() const {
  ErrorMeasure measure = worst_joint_.measure();
  measure.rms = joints_.measure().rms;
  return measure;
}

bool has_fallen(const RobotModel& robot, const Eigen::VectorXd& q_ref, const Eigen::VectorXd& q) {
  constexpr double kAngle = 0.5;  // [rad]
  constexpr double kHeightShare = 1.0 / 3.0;
  const Eigen::VectorXd error = difference(q_ref, q);
  const double height = robot.nominal_configuration()(2);
  return error.head<3>().norm() > kHeightShare * height || error.segment<3>(3).norm() > kAngle;
}

}  // namespace prowl
