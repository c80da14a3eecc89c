#include "prowl/terms/frame_terms.hpp"

#include <Eigen/Geometry>
#include <utility>

#include "prowl/error.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/terms/angle_ratio.hpp"
#include "prowl/terms/selected_entries.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Kind = Quantity::Kind;

using Axes = Eigen::Map<const Matrix3d>;  // of a frame, from the nine entries of its orientation

std::vector<std::string> xyz() { return {"x", "y", "z"}; }

/// Adds `value` times the unit matrix to two off-diagonal blocks of a Hessian.
void add_product(Ref<MatrixXd> hessian, Index first, Index second, double value) {
  hessian.block<3, 3>(first, second).diagonal().array() += value;
  hessian.block<3, 3>(second, first).diagonal().array() += value;
}

/// f = R_otherᵀ (p - p_other): f_i = b_i . d with the axes b_i.
class RelativePosition : public Term {
 public:
  RelativePosition(const std::string& frame, const std::string& other)
      : Term({{Kind::position, frame}, {Kind::orientation, other}, {Kind::position, other}}, xyz(), "m") {}

  void value(const VectorXd& y, Ref<VectorXd> f) const override {
    f = Axes(y.data() + kAxes).transpose() * (y.segment<3>(kPlace) - y.segment<3>(kOrigin));
  }
  void jacobian(const VectorXd& y, Ref<MatrixXd> f_y) const override {
    const Axes axes(y.data() + kAxes);
    f_y.setZero();
    f_y.middleCols<3>(kPlace) = axes.transpose();
    f_y.middleCols<3>(kOrigin) = -axes.transpose();
    const Vector3d off = y.segment<3>(kPlace) - y.segment<3>(kOrigin);
    for (Index i = 0; i < 3; ++i) f_y.block<1, 3>(i, kAxes + 3 * i) = off.transpose();
  }
  void hessian(const VectorXd& /*y*/, const VectorXd& multipliers, Ref<MatrixXd> f_yy) const override {
    f_yy.setZero();
    for (Index i = 0; i < 3; ++i) {
      add_product(f_yy, kAxes + 3 * i, kPlace, multipliers(i));
      add_product(f_yy, kAxes + 3 * i, kOrigin, -multipliers(i));
    }
  }

 private:
  static constexpr Index kPlace = 0, kAxes = 3, kOrigin = 12;
};

/// f = log(E), E_ij = (R_other r_i) . a_j with the axes r_i of the reference and a_j of the frame. As a function of the
/// nine entries of E it is c(x) s: x = (tr E - 1) / 2 is the cosine of the angle, s the sine times the axis.
class RelativeOrientation : public Term {
 public:
  RelativeOrientation(const std::string& frame, Matrix3d reference, const std::string& other)
      : Term(other.empty() ? std::vector<Quantity>{{Kind::orientation, frame}}
                           : std::vector<Quantity>{{Kind::orientation, frame}, {Kind::orientation, other}},
             xyz(), "rad"),
        reference_(std::move(reference)),
        is_relative_(!other.empty()) {}

  void value(const VectorXd& y, Ref<VectorXd> f) const override {
    const Matrix3d E = goal(y).transpose() * Axes(y.data());
    f = AngleRatio(cosine(E)).value * sine(E);
  }
  void jacobian(const VectorXd& y, Ref<MatrixXd> f_y) const override {
    f_y.noalias() = slopes(goal(y).transpose() * Axes(y.data())) * entries_by(y);
  }
  void hessian(const VectorXd& y, const VectorXd& multipliers, Ref<MatrixXd> f_yy) const override {
    const Matrix3d E = goal(y).transpose() * Axes(y.data());
    const AngleRatio c(cosine(E));
    const Entries g = of_cosine(), h = of_sine().transpose() * multipliers;
    const Eigen::Matrix<double, 9, 9> f_EE = (c.curvature * h.dot(Entries(E.reshaped()))) * g * g.transpose() +
                                             c.slope * (g * h.transpose() + h * g.transpose());
    const EntriesBy E_y = entries_by(y), bent = f_EE * E_y;
    f_yy.noalias() = E_y.transpose() * bent;
    if (!is_relative_) return;
    const Entries pull = slopes(E).transpose() * multipliers;
    for (Index j = 0; j < 3; ++j) {
      for (Index k = 0; k < 3; ++k) add_product(f_yy, 3 * j, 9 + 3 * k, reference_.row(k).dot(pull.segment<3>(3 * j)));
    }
  }

 private:
  using Entries = Eigen::Matrix<double, 9, 1>;                           // of E, column by column
  using EntriesBy = Eigen::Matrix<double, 9, Eigen::Dynamic, 0, 9, 18>;  // their derivatives in y

  Matrix3d goal(const VectorXd& y) const {
    return is_relative_ ? Matrix3d(Axes(y.data() + 9) * reference_) : reference_;
  }
  static double cosine(const Matrix3d& E) { return 0.5 * (E.trace() - 1.0); }
  static Vector3d sine(const Matrix3d& E) {
    return 0.5 * Vector3d(E(2, 1) - E(1, 2), E(0, 2) - E(2, 0), E(1, 0) - E(0, 1));
  }
  static Entries of_cosine() { return 0.5 * Entries(Matrix3d::Identity().reshaped()); }
  static Eigen::Matrix<double, 3, 9> of_sine() {
    Eigen::Matrix<double, 3, 9> slopes;
    for (Index i = 0; i < 9; ++i) slopes.col(i) = sine(Entries::Unit(i).reshaped(3, 3));
    return slopes;
  }
  /// In the entries of E.
  static Eigen::Matrix<double, 3, 9> slopes(const Matrix3d& E) {
    const AngleRatio c(cosine(E));
    return c.value * of_sine() + c.slope * sine(E) * of_cosine().transpose();
  }
  EntriesBy entries_by(const VectorXd& y) const {
    EntriesBy E_y = EntriesBy::Zero(9, y.size());
    const Matrix3d goal = this->goal(y);
    for (Index j = 0; j < 3; ++j) {
      E_y.block<3, 3>(3 * j, 3 * j) = goal.transpose();
      for (Index k = 0; is_relative_ && k < 3; ++k) {
        E_y.block<3, 3>(3 * j, 9 + 3 * k) = reference_.row(k).transpose() * y.segment<3>(3 * j).transpose();
      }
    }
    return E_y;
  }

  Matrix3d reference_;
  bool is_relative_;
};

/// f = 1/2 sum_k a_k x a'_k of the axes a_k: each of them turns with w, a'_k = w x a_k.
class AngularVelocity : public Term {
 public:
  explicit AngularVelocity(const std::string& frame)
      : Term({{Kind::orientation, frame}, {Kind::orientation_rate, frame}}, xyz(), "rad/s") {}

  void value(const VectorXd& y, Ref<VectorXd> f) const override {
    f.setZero();
    for (const Index k : {0, 3, 6}) f += 0.5 * Vector3d(y.segment<3>(k)).cross(Vector3d(y.segment<3>(kRates + k)));
  }
  void jacobian(const VectorXd& y, Ref<MatrixXd> f_y) const override {
    for (const Index k : {0, 3, 6}) {
      f_y.middleCols<3>(k) = -0.5 * so3::skew(y.segment<3>(kRates + k));
      f_y.middleCols<3>(kRates + k) = 0.5 * so3::skew(y.segment<3>(k));
    }
  }
  void hessian(const VectorXd& /*y*/, const VectorXd& multipliers, Ref<MatrixXd> f_yy) const override {
    f_yy.setZero();
    const Matrix3d half = 0.5 * so3::skew(multipliers);
    for (const Index k : {0, 3, 6}) {
      f_yy.block<3, 3>(k, kRates + k) = -half;
      f_yy.block<3, 3>(kRates + k, k) = half;
    }
  }

 private:
  static constexpr Index kRates = 9;
};

/// The rotation that takes the axis n to the direction v = w / |w|, both in the frame: c(n . v) n x v, without its
/// component along n, which is zero. w_j = a_j . d with the frame's axes a_j and d = direction, or target - position.
class Pointing : public Term {
 public:
  Pointing(const std::string& frame, const Vector3d& axis, Vector3d towards, bool is_target)
      : Term(is_target ? std::vector<Quantity>{{Kind::orientation, frame}, {Kind::position, frame}}
                       : std::vector<Quantity>{{Kind::orientation, frame}},
             {"first angle", "second angle"}, "rad"),
        axis_(axis.normalized()),
        towards_(std::move(towards)),
        is_target_(is_target) {
    Index least = 0;
    axis_.cwiseAbs().minCoeff(&least);
    const Vector3d first = (Vector3d::Unit(least) - axis_(least) * axis_).normalized();
    across_.col(0) = first.cross(axis_);
    across_.col(1) = axis_.cross(first).cross(axis_);
  }

  void value(const VectorXd& y, Ref<VectorXd> f) const override {
    const Vector3d v = (Axes(y.data()).transpose() * direction(y)).normalized();
    f = AngleRatio(axis_.dot(v)).value * across_.transpose() * v;
  }
  void jacobian(const VectorXd& y, Ref<MatrixXd> f_y) const override {
    const Vector3d w = Axes(y.data()).transpose() * direction(y);
    const Eigen::Matrix<double, 2, 3> by_w = slopes(w.normalized()) * normalised(w);
    differentiate(y, by_w, f_y);
  }
  void hessian(const VectorXd& y, const VectorXd& multipliers, Ref<MatrixXd> f_yy) const override {
    const Vector3d w = Axes(y.data()).transpose() * direction(y), v = w.normalized();
    const AngleRatio c(axis_.dot(v));
    const Vector3d h = across_ * multipliers, on_v = slopes(v).transpose() * multipliers;
    const Matrix3d f_vv = (c.curvature * h.dot(v)) * axis_ * axis_.transpose() +
                          c.slope * (h * axis_.transpose() + axis_ * h.transpose());
    const Matrix3d v_w = normalised(w), on_both = v * on_v.transpose();
    const Matrix3d bent =
        on_both + on_both.transpose() + v.dot(on_v) * (Matrix3d::Identity() - 3.0 * v * v.transpose());
    const Matrix3d f_ww = v_w * f_vv * v_w - bent / w.squaredNorm();
    ByEntries w_y(3, y.size());
    differentiate(y, Matrix3d::Identity(), w_y);
    const ByEntries on_w_y = f_ww * w_y;
    f_yy.noalias() = w_y.transpose() * on_w_y;
    if (!is_target_) return;
    const Vector3d on_w = v_w * on_v;
    for (Index j = 0; j < 3; ++j) add_product(f_yy, 3 * j, kPlace, -on_w(j));
  }

 private:
  static constexpr Index kPlace = 9;
  using ByEntries = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 12>;  // derivatives in y

  Vector3d direction(const VectorXd& y) const {
    return is_target_ ? Vector3d(towards_ - y.segment<3>(kPlace)) : towards_;
  }
  /// Derivative of w / |w| in w.
  static Matrix3d normalised(const Vector3d& w) {
    const Vector3d v = w.normalized();
    return (Matrix3d::Identity() - v * v.transpose()) / w.norm();
  }
  Eigen::Matrix<double, 2, 3> slopes(const Vector3d& v) const {
    const AngleRatio c(axis_.dot(v));
    return c.value * across_.transpose() + c.slope * (across_.transpose() * v) * axis_.transpose();
  }
  /// Derivatives in y from those in w, one row per function.
  template <class ByW, class ByY>
  void differentiate(const VectorXd& y, const ByW& by_w, ByY& by_y) const {
    const Axes axes(y.data());
    for (Index j = 0; j < 3; ++j) by_y.template middleCols<3>(3 * j) = by_w.col(j) * direction(y).transpose();
    if (is_target_) by_y.template middleCols<3>(kPlace) = -by_w * axes.transpose();
  }

  Vector3d axis_, towards_;
  bool is_target_;
  Eigen::Matrix<double, 3, 2> across_;  ///< h_m with f_m = c h_m . v
};

void check_direction(const char* what, const Vector3d& direction) {
  constexpr double kShortest = 1e-6;  // below, its direction is rounding
  if (direction.allFinite() && direction.norm() >= kShortest) return;
  throw InputError(std::string("frame_pointing: ") + what + " has no direction; need a finite vector of length > 0");
}

}  // namespace

std::shared_ptr<const Term> frame_position(const std::string& frame, const std::string& relative_to) {
  if (relative_to.empty()) return world_vector({Kind::position, frame}, "m");
  return std::make_shared<RelativePosition>(frame, relative_to);
}

std::shared_ptr<const Term> frame_orientation(const std::string& frame, const Matrix3d& reference,
                                              const std::string& relative_to) {
  constexpr double kRounding = 1e-6;
  if (!reference.isUnitary(kRounding) || reference.determinant() < 0.0) {
    throw InputError("frame_orientation: the reference is no rotation");
  }
  return std::make_shared<RelativeOrientation>(frame, reference, relative_to);
}

std::shared_ptr<const Term> frame_velocity(const std::string& frame) {
  return world_vector({Kind::velocity, frame}, "m/s");
}

std::shared_ptr<const Term> frame_angular_velocity(const std::string& frame) {
  return std::make_shared<AngularVelocity>(frame);
}

std::shared_ptr<const Term> frame_pointing_along(const std::string& frame, const Vector3d& axis,
                                                 const Vector3d& direction) {
  check_direction("axis", axis);
  check_direction("direction", direction);
  return std::make_shared<Pointing>(frame, axis, direction, false);
}

std::shared_ptr<const Term> frame_pointing_at(const std::string& frame, const Vector3d& axis, const Vector3d& target) {
  check_direction("axis", axis);
  if (!target.allFinite()) throw InputError("frame_pointing_at: the target is not finite");
  return std::make_shared<Pointing>(frame, axis, target, true);
}

}  // namespace prowl
