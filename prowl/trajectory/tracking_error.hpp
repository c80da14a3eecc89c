#pragma once

#include <Eigen/Core>
#include <limits>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Size of an error over a run; `rest`: largest in its last kRestWindow, NaN if the run ended
/// early. NaN values propagate.
struct ErrorMeasure {
  double largest = 0.0, rms = 0.0, rest = std::numeric_limits<double>::quiet_NaN();
};

inline constexpr double kRestWindow = 0.2;  ///< [s]

/// Accumulates an ErrorMeasure.
class ErrorSum {
 public:
  void add(double value, bool at_rest);
  ErrorMeasure measure() const;

 private:
  double largest_ = 0.0, squares_ = 0.0, rest_ = ErrorMeasure{}.rest;
  long count_ = 0;
};

/// Accumulates the deviation of a robot from its plan.
class TrackingError {
 public:
  void add(const Eigen::VectorXd& q_ref, const Eigen::VectorXd& q, bool at_rest);

  ErrorMeasure base_position() const { return position_.measure(); }  ///< distance [m]
  ErrorMeasure base_angle() const { return angle_.measure(); }        ///< [rad]
  ErrorMeasure joints() const;  ///< largest: of the worst joint; rms: of all [rad]

 private:
  ErrorSum position_, angle_, worst_joint_, joints_;
};

/// True if the base deviates from the plan by more than 0.5 rad or a third of its nominal height:
/// the robot falls.
bool has_fallen(const RobotModel& robot, const Eigen::VectorXd& q_ref, const Eigen::VectorXd& q);

}  // namespace prowl
