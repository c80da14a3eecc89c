#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "alternatives/collocation/charts/base_chart.hpp"
#include "prowl/error.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// g(s), s = |e|², and its first two derivatives, of  Jr⁻¹ ω = ω + 1/2 e × ω + g e × (e × ω). g =
/// 1/s − (1 + cos t) / (2 t sin t) with t = √s; as a power series Σ 2 ζ(2n) / (2π)²ⁿ sⁿ⁻¹, without
/// cancellation at 0.
constexpr double kLongest = 4.4;  // [rad]
constexpr int kTerms = 48;        // (t / 2π)²ⁿ is below rounding for t up to kLongest

std::array<double, kTerms> coefficients() {
  std::array<double, kTerms> c{};
  double factor = 1.0;
  for (int n = 1; n <= kTerms; ++n) {
    factor /= 4.0 * std::numbers::pi * std::numbers::pi;
    c[n - 1] = 2.0 * std::riemann_zeta(2.0 * n) * factor;
  }
  return c;
}

std::array<double, 3> series(double s) {
  static const std::array<double, kTerms> all = coefficients();
  std::array<double, 3> g{};
  double power = 1.0, power_d = 0.0, power_dd = 0.0;  // sⁿ⁻¹ and its derivatives
  for (const double c : all) {
    g[0] += c * power;
    g[1] += c * power_d;
    g[2] += c * power_dd;
    power_dd = s * power_dd + 2.0 * power_d;
    power_d = s * power_d + power;
    power *= s;
  }
  return g;
}

class ExponentialChart : public BaseChart {
 public:
  explicit ExponentialChart(const Matrix3d& origin) : origin_(origin) {}

  Matrix3d rotation(const Vector3d& e) const override { return origin_ * so3::exp(e); }

  Vector3d coordinates(const Matrix3d& R, const Vector3d& near) const override {
    const Vector3d e = so3::log(origin_.transpose() * R);
    const double angle = e.norm();
    if (angle == 0.0) return Vector3d::Zero();
    // The other rotation vector of the same rotation.
    const Vector3d other = (1.0 - 2.0 * std::numbers::pi / angle) * e;
    const Vector3d chosen = (other - near).norm() < (e - near).norm() ? other : e;
    if (chosen.norm() > kLongest)
      throw InputError(
          "orientation: the base turns further than 4.4 rad from the start, the range of a rotation vector");
    return chosen;
  }

  Matrix3d rate(const Vector3d& e) const override { return so3::right_jacobian(e); }
  Matrix3d bend(const Vector3d& e, const Vector3d& lambda) const override {
    return so3::right_jacobian_derivative(e, lambda);
  }
  Matrix3d inverse_rate(const Vector3d& e) const override { return so3::right_jacobian_inverse(e); }

  Matrix3d inverse_rate_slope(const Vector3d& e, const Vector3d& w) const override {
    const auto [g, g_d, g_dd] = series(e.squaredNorm());
    const Vector3d u = e * e.dot(w) - e.squaredNorm() * w;  // e × (e × ω)
    const Matrix3d u_slope = e * w.transpose() + e.dot(w) * Matrix3d::Identity() - 2.0 * w * e.transpose();
    return -0.5 * so3::skew(w) + g * u_slope + 2.0 * g_d * u * e.transpose();
  }

  Matrix3d inverse_rate_curvature(const Vector3d& e, const Vector3d& w, const Vector3d& lambda) const override {
    const auto [g, g_d, g_dd] = series(e.squaredNorm());
    const double u = lambda.dot(e) * e.dot(w) - e.squaredNorm() * lambda.dot(w);
    const Vector3d u_slope = lambda * e.dot(w) + w * lambda.dot(e) - 2.0 * lambda.dot(w) * e;
    const Matrix3d u_bend =
        lambda * w.transpose() + w * lambda.transpose() - 2.0 * lambda.dot(w) * Matrix3d::Identity();
    const Matrix3d cross = 2.0 * g_d * e * u_slope.transpose();
    return g * u_bend + cross + cross.transpose() +
           u * (2.0 * g_d * Matrix3d::Identity() + 4.0 * g_dd * e * e.transpose());
  }

 private:
  Matrix3d origin_;
};

}  // namespace

std::unique_ptr<BaseChart> exponential_chart(const Matrix3d& origin) {
  return std::make_unique<ExponentialChart>(origin);
}

}  // namespace prowl
