#include <Eigen/LU>

#include "alternatives/collocation/dynamics/dynamics_form.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The dynamics with the acceleration eliminated:  (x, v, tau, w, shared)  ->  (a, rows, cost)
///
/// a solves the dynamics c(q, v, a, tau) = 0, which are linear in a: Pardo et al. 2016, with the
/// missing P restored. Derivatives: da = -c_a^-1 dc; the Hessian of ν · a + μ · (rows, cost) is Tᵀ
/// H T, T the derivative of all columns in the inputs, H the Hessian of μ · (rows, cost) + λ · c,
/// with λ such that the gradient in a vanishes.
class EliminatingPoint : public PointFunction {
 public:
  EliminatingPoint(ChartedNode& node, const Instant& instant, std::vector<int> rows)
      : PointFunction(node, instant, std::move(rows)), nv_(node.num_dofs()) {}

  int num_inputs() const override { return PointFunction::num_inputs() - nv_; }
  int acceleration_size() const override { return nv_; }

  void evaluate(const VectorXd& x, VectorXd& y) override {
    solve(x);
    VectorXd rest;
    PointFunction::evaluate(with_acceleration_, rest);
    y.resize(num_outputs());
    y << with_acceleration_.segment(2 * nv_, nv_), rest;
  }

  void evaluate_with_derivatives(const VectorXd& x, VectorXd& y, MatrixXd& dy) override {
    solve(x);
    VectorXd rest;
    MatrixXd slope;
    PointFunction::evaluate_with_derivatives(with_acceleration_, rest, slope);
    const MatrixXd& J = values().rows_jacobian;
    MatrixXd others(nv_, num_inputs());
    others << J.topLeftCorner(nv_, 2 * nv_), J.topRightCorner(nv_, num_inputs() - 2 * nv_);
    acceleration_slope_ = dynamics_.solve(-others);
    y.resize(num_outputs());
    y << with_acceleration_.segment(2 * nv_, nv_), rest;
    dy.resize(num_outputs(), num_inputs());
    dy << acceleration_slope_, compressed(slope);
  }

  void hessian(const VectorXd& /*x*/, const VectorXd& weights, MatrixXd& result) override {
    VectorXd multipliers = multipliers_of_rows(weights.tail(weights.size() - nv_));
    const double cost_factor = weights(weights.size() - 1);
    const VectorXd on_acceleration = weights.head(nv_) +
                                     values().rows_jacobian.middleCols(2 * nv_, nv_).transpose() * multipliers +
                                     cost_factor * values().cost_gradient.segment(2 * nv_, nv_);
    multipliers.head(nv_) = -VectorXd(dynamics_.transpose().solve(on_acceleration));
    MatrixXd all;
    hessian_of_columns(cost_factor, multipliers, all);
    result = compressed(compressed(all).transpose());
  }

 private:
  /// The dynamics are linear in a: one Newton step from a = 0.
  void solve(const VectorXd& x) {
    if (last_inputs_.size() == x.size() && last_inputs_ == x) return;
    last_inputs_.resize(0);
    with_acceleration_.resize(PointFunction::num_inputs());
    with_acceleration_ << x.head(2 * nv_), VectorXd::Zero(nv_), x.tail(x.size() - 2 * nv_);
    VectorXd unused;
    MatrixXd unused_slope;
    PointFunction::evaluate_with_derivatives(with_acceleration_, unused, unused_slope);
    dynamics_.compute(values().rows_jacobian.block(0, 2 * nv_, nv_, nv_));
    with_acceleration_.segment(2 * nv_, nv_) = dynamics_.solve(-values().rows.head(nv_));
    last_inputs_ = x;
  }

  /// m T.
  MatrixXd compressed(const MatrixXd& m) const {
    MatrixXd result(m.rows(), num_inputs());
    result << m.leftCols(2 * nv_), m.rightCols(num_inputs() - 2 * nv_);
    result.noalias() += m.middleCols(2 * nv_, nv_) * acceleration_slope_;
    return result;
  }

  int nv_;
  VectorXd last_inputs_, with_acceleration_;
  Eigen::PartialPivLU<MatrixXd> dynamics_;  ///< of c_a
  MatrixXd acceleration_slope_;             ///< of a in the inputs
};

/// Only tau is a variable, a = Mc⁻¹ (P (S' tau − h) + M C v): Pardo et al. 2016.
class ForwardForm : public DynamicsForm {
 public:
  bool eliminates_acceleration() const override { return true; }
  std::unique_ptr<PointFunction> at(ChartedNode& node, const Instant& instant, std::vector<int> rows) const override {
    return std::make_unique<EliminatingPoint>(node, instant, std::move(rows));
  }
};

}  // namespace

std::unique_ptr<DynamicsForm> forward_dynamics() { return std::make_unique<ForwardForm>(); }

}  // namespace prowl
