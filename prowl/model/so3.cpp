#include "prowl/model/so3.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace prowl::so3 {

namespace {

struct Coefficients {
  double alpha, beta;      ///< of Jr
  double alpha_d, beta_d;  ///< (dα/dt)/t and (dβ/dt)/t
};

Coefficients coefficients(double t) {
  Coefficients c{};
  if (t < 1.0) {
    // The closed forms lose all digits towards t = 0. Power series: α = Σ (-t²)ᵏ/(2k+2)!,  β = Σ (-t²)ᵏ/(2k+3)!
    double power = 1.0;      // (-t²)ᵏ
    double power_d = 0.0;    // its derivative in t, divided by t: -2k (-t²)ᵏ⁻¹
    double factorial = 2.0;  // (2k+2)!
    for (int k = 0; k < 10; ++k) {
      const double next = factorial * (2 * k + 3);  // (2k+3)!
      c.alpha += power / factorial;
      c.beta += power / next;
      c.alpha_d += power_d / factorial;
      c.beta_d += power_d / next;
      power_d = -2.0 * (k + 1) * power;
      power *= -t * t;
      factorial = next * (2 * k + 4);
    }
    return c;
  }
  const double t2 = t * t;
  c.alpha = (1.0 - std::cos(t)) / t2;
  c.beta = (t - std::sin(t)) / (t2 * t);
  c.alpha_d = (std::sin(t) / t - 2.0 * c.alpha) / t2;
  c.beta_d = (c.alpha - 3.0 * c.beta) / t2;
  return c;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& w) {
  Eigen::Matrix3d W;
  W << 0.0, -w.z(), w.y(),  //
      w.z(), 0.0, -w.x(),   //
      -w.y(), w.x(), 0.0;
  return W;
}

Eigen::Matrix3d exp(const Eigen::Vector3d& theta) {
  return Eigen::AngleAxisd(theta.stableNorm(), theta.stableNormalized()).toRotationMatrix();
}

Eigen::Vector3d log(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd rotation(R);  // through a quaternion: accurate near 0 and near pi
  return rotation.angle() * rotation.axis();
}

Eigen::Matrix3d shortest_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  if (cosine < -1.0 + 1e-12) {  // the axis is rounding: by way of any perpendicular direction
    const Eigen::Vector3d between = a.unitOrthogonal();
    return shortest_rotation(between, b) * shortest_rotation(a, between);
  }
  const double root = std::sqrt((1.0 + cosine) * 2.0);
  const Eigen::Vector3d axis = a.cross(b) * (1.0 / root);
  return Eigen::Quaterniond(0.5 * root, axis.x(), axis.y(), axis.z()).toRotationMatrix();
}

Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& theta) {
  const Coefficients c = coefficients(theta.norm());
  const Eigen::Matrix3d W = skew(theta);
  return Eigen::Matrix3d::Identity() - c.alpha * W + c.beta * W * W;
}

Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& theta) {
  // 1/t² - (1 + cos t)/(2 t sin t) = -alpha_d/(2 alpha), which has no cancellation at 0 and no pole at pi.
  const Coefficients c = coefficients(theta.norm());
  const Eigen::Matrix3d W = skew(theta);
  return Eigen::Matrix3d::Identity() + 0.5 * W - c.alpha_d / (2.0 * c.alpha) * W * W;
}

Eigen::Matrix3d right_jacobian_derivative(const Eigen::Vector3d& theta, const Eigen::Vector3d& lambda) {
  const Coefficients c = coefficients(theta.norm());
  const double dot = lambda.dot(theta);
  const Eigen::Matrix3d outer = theta * lambda.transpose();
  const Eigen::Matrix3d B = -c.alpha_d * theta * lambda.cross(theta).transpose() +
                            c.beta_d * (dot * theta * theta.transpose() - theta.squaredNorm() * outer) +
                            c.beta * (dot * Eigen::Matrix3d::Identity() - outer);
  return 0.5 * (B + B.transpose());
}

}  // namespace prowl::so3
