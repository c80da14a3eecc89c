#include "alternatives/collocation/charted_node.hpp"

#include "prowl/model/configuration.hpp"

namespace prowl {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

ChartedNode::ChartedNode(const DiscreteProblem& discrete, int phase, const PhaseContacts& contacts,
                         const StabilisationOfStep& stabilisation, const ContactRows& contact_rows,
                         const BaseChart& chart, VectorXd anchor_origin)
    : discrete_(discrete),
      phase_(phase),
      chart_(chart),
      anchor_origin_(std::move(anchor_origin)),
      functions_(discrete, phase, contacts, stabilisation),
      contact_rows_(contact_rows) {}

double ChartedNode::lower(int node, int row) const {
  const int own = functions_.num_rows(node);
  return row < own ? functions_.lower(node, row) : -contact_rows_.tolerance(row - own);
}

double ChartedNode::upper(int node, int row) const {
  const int own = functions_.num_rows(node);
  return row < own ? functions_.upper(node, row) : contact_rows_.tolerance(row - own);
}

std::string ChartedNode::describe_coordinate(int i) const {
  constexpr const char* kBase[] = {"base x",          "base y",          "base z",
                                   "base rotation 1", "base rotation 2", "base rotation 3"};
  return i < 6 ? kBase[i] : robot().joint_names()[i - 6];
}

std::string ChartedNode::describe_row(int node, int row) const {
  const int own = functions_.num_rows(node);
  return row < own ? functions_.describe_row(node, row) : contact_rows_.describe(row - own);
}

VectorXd ChartedNode::configuration(const VectorXd& columns) const {
  const int nv = robot().nv();
  VectorXd q(nv + 1);
  q.head<3>() = columns.head<3>();
  set_base_rotation(q, chart_.rotation(columns.segment<3>(3)));
  q.tail(nv - 6) = columns.segment(6, nv - 6);
  return q;
}

double ChartedNode::duration(const VectorXd& columns) const {
  return functions_.has_free_duration() ? columns(functions_.num_variables()) : phase().duration.min;
}

// In its own chart, the tangent at R(e).
NodePoint ChartedNode::point(const Instant& at, const VectorXd& columns) const {
  const int nv = robot().nv(), nu = robot().nu();
  NodePoint point;
  point.node = at.node;
  point.theta.setZero();
  point.q = configuration(columns);
  point.v = columns.segment(nv, nv);
  point.a = columns.segment(2 * nv, nv);
  point.tau = columns.segment(3 * nv, nu);
  point.w = columns.segment(3 * nv + nu, static_cast<Index>(functions_.chosen_rows().size()));
  point.duration = duration(columns);
  point.anchors = anchor_origin_;
  Index column = first_foothold_variable();
  for (std::size_t l = 0; l < functions_.landed().size(); ++l) {
    point.anchors.segment<3>(3 * functions_.landed()[l]) += functions_.landed_axes()[l] * columns.segment<2>(column);
    column += 2;
  }
  point.cost_weight = at.cost_share * point.duration / discrete_.mesh.phases[phase_].intervals();
  point.terminal_weight = at.terminal_weight;
  return point;
}

void ChartedNode::evaluate(const Instant& at, const VectorXd& columns, Values& values) {
  const NodePoint where = point(at, columns);
  functions_.evaluate(where, inner_);
  values.cost = inner_.cost;
  values.forces = inner_.forces;
  values.rows.resize(num_rows(at.node));
  values.rows.head(inner_.rows.size()) = inner_.rows;
  contact_rows_.evaluate(functions_.kinematics(), functions_.at(), values.rows.tail(contact_rows_.count()));
}

void ChartedNode::gather(const ContactRows::Derivatives& derivatives, const NodePoint& where,
                         Eigen::Ref<MatrixXd> rows) const {
  const int nv = robot().nv();
  rows.setZero();
  rows.leftCols(nv) = derivatives.q;
  rows.middleCols(nv, nv) = derivatives.v;
  rows.middleCols(2 * nv, nv) = derivatives.a;
  if (functions_.has_free_duration()) {
    rows.col(functions_.num_variables()) = derivatives.gains * functions_.gains(where, 1);
  }
  for (std::size_t l = 0; l < functions_.landed().size(); ++l) {
    rows.middleCols<2>(first_foothold_variable() + static_cast<Index>(2 * l)) =
        derivatives.anchors.middleCols<3>(3 * functions_.landed()[l]) * functions_.landed_axes()[l];
  }
}

void ChartedNode::evaluate_with_derivatives(const Instant& at, const VectorXd& columns, Values& values) {
  const NodePoint where = point(at, columns);
  functions_.evaluate_with_derivatives(where, inner_);
  values.cost = inner_.cost;
  values.forces = inner_.forces;
  values.cost_gradient = inner_.cost_gradient;
  const Index own = inner_.rows.size(), extra = contact_rows_.count();
  values.rows.resize(own + extra);
  values.rows.head(own) = inner_.rows;
  values.rows_jacobian.resize(own + extra, num_columns());
  values.rows_jacobian.topRows(own) = inner_.rows_jacobian;
  contact_rows_.evaluate(functions_.kinematics(), functions_.at(), values.rows.tail(extra));
  contact_rows_.derivatives(functions_.at(), contact_derivatives_);
  gather(contact_derivatives_, where, values.rows_jacobian.bottomRows(extra));

  const Matrix3d E = chart_.rate(columns.segment<3>(3));
  values.rows_jacobian.middleCols<3>(3) = (values.rows_jacobian.middleCols<3>(3) * E).eval();
  values.cost_gradient.segment<3>(3) = (E.transpose() * values.cost_gradient.segment<3>(3)).eval();
}

void ChartedNode::add_contact_hessian(const NodePoint& where, const VectorXd& multipliers, MatrixXd& result) {
  const int nv = robot().nv();
  const ContactRows::Hessian& h = contact_rows_.hessian(functions_.at(), multipliers);
  result.topLeftCorner(nv, nv) += h.qq;
  result.block(nv, nv, nv, nv) += h.vv;
  const auto add_both = [&result](Index row, Index col, const MatrixXd& block) {
    result.block(row, col, block.rows(), block.cols()) += block;
    result.block(col, row, block.cols(), block.rows()) += block.transpose();
  };
  add_both(0, nv, h.qv);
  add_both(0, 2 * nv, h.qa);
  if (!functions_.has_free_duration() || h.de.isZero(0.0)) return;
  const int duration = functions_.num_variables();
  const Eigen::Vector2d slope = functions_.gains(where, 1);
  add_both(0, duration, h.qgains * slope);
  add_both(nv, duration, h.vgains * slope);
  for (std::size_t l = 0; l < functions_.landed().size(); ++l) {
    const Eigen::Vector2d on_foothold =
        functions_.landed_axes()[l].transpose() * h.de.segment<3>(3 * functions_.landed()[l]);
    add_both(first_foothold_variable() + static_cast<Index>(2 * l), duration, -slope(1) * on_foothold);
  }
  result(duration, duration) += contact_rows_.on_gains(functions_.at()).dot(functions_.gains(where, 2));
}

void ChartedNode::hessian(const Instant& at, const VectorXd& columns, double cost_factor, const VectorXd& multipliers,
                          MatrixXd& result) {
  const NodePoint where = point(at, columns);
  const Index own = functions_.num_rows(at.node), extra = contact_rows_.count();
  functions_.linearise(where, cost_factor, multipliers.head(own), inner_, result);
  result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
  // Total gradient in the tangent of the rotation.
  Vector3d pull = cost_factor * inner_.cost_gradient.segment<3>(3) +
                  inner_.rows_jacobian.middleCols<3>(3).transpose() * multipliers.head(own);
  if (extra > 0) {
    VectorXd unused(extra);
    contact_rows_.evaluate(functions_.kinematics(), functions_.at(), unused);
    contact_rows_.derivatives(functions_.at(), contact_derivatives_);
    pull += contact_derivatives_.q.middleCols<3>(3).transpose() * multipliers.tail(extra);
    if (functions_.hessian_kind() == HessianKind::exact) add_contact_hessian(where, multipliers.tail(extra), result);
  }
  const Vector3d e = columns.segment<3>(3);
  const Matrix3d E = chart_.rate(e);
  result.middleCols<3>(3) = (result.middleCols<3>(3) * E).eval();
  result.middleRows<3>(3) = (E.transpose() * result.middleRows<3>(3)).eval();
  if (functions_.hessian_kind() == HessianKind::exact) result.block<3, 3>(3, 3) += chart_.bend(e, pull);
}

}  // namespace prowl
