#include "prowl/trajectory/hermite_interval.hpp"

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

/// Cubic with values y0, y1 and slopes d0, d1 at the ends of an interval of length h.
struct Cubic {
  VectorXd y0, y1, d0, d1;
  double h;

  VectorXd value(double s) const {
    const double u = s / h, w = 1.0 - u;
    return w * w * (1.0 + 2.0 * u) * y0 + u * u * (1.0 + 2.0 * w) * y1 + h * u * w * (w * d0 - u * d1);
  }
  VectorXd slope(double s) const {
    const double u = s / h, w = 1.0 - u;
    return 6.0 * u * w / h * (y1 - y0) + w * (1.0 - 3.0 * u) * d0 + u * (1.0 - 3.0 * w) * d1;
  }
};

/// φ: its rotation is a rotation vector from the left end, so that its rate there is not the angular velocity.
Cubic displacement(const TrajectoryPoint& left, const TrajectoryPoint& right) {
  Cubic cubic{VectorXd::Zero(left.v.size()), difference(left.q, right.q), tangent_rate(left), tangent_rate(right),
              right.time - left.time};
  const Eigen::Vector3d turn = cubic.y1.segment<3>(3);
  cubic.d1.segment<3>(3) = so3::right_jacobian_inverse(turn) * right.v.segment<3>(3);
  return cubic;
}

}  // namespace

VectorXd hermite_torque(const TrajectoryPoint& left, const TrajectoryPoint& right, const VectorXd* middle_torque,
                        double s) {
  const double u = s / (right.time - left.time), w = 1.0 - u;
  if (!middle_torque) return w * left.tau + u * right.tau;
  return w * (w - u) * left.tau + 4.0 * u * w * *middle_torque + u * (u - w) * right.tau;
}

TrajectoryPoint hermite_point(const TrajectoryPoint& left, const TrajectoryPoint& right, const VectorXd* middle_torque,
                              double s) {
  const double h = right.time - left.time;
  const Cubic velocity{left.v, right.v, left.a, right.a, h};
  TrajectoryPoint point;
  point.time = left.time + s;
  point.phase = left.phase;
  point.q = integrate(left.q, displacement(left, right).value(s));
  point.v = velocity.value(s);
  point.a = velocity.slope(s);
  point.tau = hermite_torque(left, right, middle_torque, s);
  point.force = (1.0 - s / h) * left.force + s / h * right.force;
  return point;
}

VectorXd hermite_rate(const TrajectoryPoint& left, const TrajectoryPoint& right, double s) {
  const Cubic cubic = displacement(left, right);
  VectorXd rate = cubic.slope(s);
  rate.segment<3>(3) = (so3::right_jacobian(cubic.value(s).segment<3>(3)) * rate.segment<3>(3)).eval();
  return rate;
}

}  // namespace prowl
