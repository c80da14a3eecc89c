#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "alternatives/collocation/charts/base_chart.hpp"
#include "prowl/error.hpp"

namespace prowl {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// x plus whole turns, closest to `near`.
double next_to(double x, double near) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return x + kTurn * std::round((near - x) / kTurn);
}

// With c, s of the pitch e1 and C, S of the last angle e2:
//   ω = (C c ė0 + S ė1,  −S c ė0 + C ė1,  s ė0 + ė2)
//   ė0 = (C ω0 − S ω1) / c,   ė1 = S ω0 + C ω1,   ė2 = ω2 − s ė0
class EulerChart : public BaseChart {
 public:
  Matrix3d rotation(const Vector3d& e) const override {
    using Eigen::AngleAxisd;
    return (AngleAxisd(e.x(), Vector3d::UnitX()) * AngleAxisd(e.y(), Vector3d::UnitY()) *
            AngleAxisd(e.z(), Vector3d::UnitZ()))
        .toRotationMatrix();
  }

  Vector3d coordinates(const Matrix3d& R, const Vector3d& near) const override {
    const double cosine = std::hypot(R(1, 2), R(2, 2));
    // Closer to the singularity roll and yaw are rounding.
    constexpr double kLeast = 1e-6;
    if (cosine < kLeast) throw InputError("orientation: Euler angles are not unique at 90 degrees of pitch");
    const Vector3d e(std::atan2(-R(1, 2), R(2, 2)), std::atan2(R(0, 2), cosine), std::atan2(-R(0, 1), R(0, 0)));
    return {next_to(e.x(), near.x()), e.y(), next_to(e.z(), near.z())};
  }

  Matrix3d rate(const Vector3d& e) const override {
    const double c = std::cos(e.y()), s = std::sin(e.y()), C = std::cos(e.z()), S = std::sin(e.z());
    Matrix3d E;
    E << C * c, S, 0.0,  //
        -S * c, C, 0.0,  //
        s, 0.0, 1.0;
    return E;
  }

  Matrix3d bend(const Vector3d& e, const Vector3d& l) const override {
    const double c = std::cos(e.y()), s = std::sin(e.y()), C = std::cos(e.z()), S = std::sin(e.z());
    // Slopes of λᵀ E in e1 and in e2; e0 does not appear.
    const Vector3d in_pitch(-C * s * l.x() + S * s * l.y() + c * l.z(), 0.0, 0.0);
    const Vector3d in_yaw(-S * c * l.x() - C * c * l.y(), C * l.x() - S * l.y(), 0.0);
    Matrix3d B = Matrix3d::Zero();
    B.row(1) = in_pitch;
    B.row(2) = in_yaw;
    return 0.5 * (B + B.transpose());
  }

  Matrix3d inverse_rate(const Vector3d& e) const override {
    const double c = std::cos(e.y()), t = std::tan(e.y()), C = std::cos(e.z()), S = std::sin(e.z());
    Matrix3d inverse;
    inverse << C / c, -S / c, 0.0,  //
        S, C, 0.0,                  //
        -t * C, t * S, 1.0;
    return inverse;
  }

  Matrix3d inverse_rate_slope(const Vector3d& e, const Vector3d& w) const override {
    const double c = std::cos(e.y()), s = std::sin(e.y()), C = std::cos(e.z()), S = std::sin(e.z());
    const double across = C * w.x() - S * w.y(), across_d = -S * w.x() - C * w.y();  // and its derivative in e2
    Matrix3d slope;
    slope << 0.0, across * s / (c * c), across_d / c,  //
        0.0, 0.0, across,                              //
        0.0, -across / (c * c), -across_d * s / c;
    return slope;
  }

  Matrix3d inverse_rate_curvature(const Vector3d& e, const Vector3d& w, const Vector3d& l) const override {
    const double c = std::cos(e.y()), s = std::sin(e.y()), C = std::cos(e.z()), S = std::sin(e.z());
    const double across = C * w.x() - S * w.y(), across_d = -S * w.x() - C * w.y();
    // λ · E⁻¹ ω = (λ0 / c − λ2 s / c) across − λ1 across_d + λ2 ω2
    const double f = (l.x() - l.z() * s) / c;
    const double f_d = (l.x() * s - l.z()) / (c * c);
    const double f_dd = (l.x() * (1.0 + s * s) - 2.0 * l.z() * s) / (c * c * c);
    Matrix3d H = Matrix3d::Zero();
    H(1, 1) = f_dd * across;
    H(1, 2) = H(2, 1) = f_d * across_d;
    H(2, 2) = -f * across + l.y() * across_d;
    return H;
  }
};

}  // namespace

std::unique_ptr<BaseChart> euler_chart() { return std::make_unique<EulerChart>(); }

}  // namespace prowl
