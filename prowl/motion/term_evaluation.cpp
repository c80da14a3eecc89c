#include "prowl/motion/term_evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prowl/error.hpp"
#include "prowl/model/robot_frame.hpp"

namespace prowl {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = Quantity::Kind;

TermEvaluation::TermEvaluation(const RobotModel& robot, const TermUse& use, const std::vector<int>& contacts)
    : name_(use.name),
      term_(use.term),
      mass_(robot.mass()),
      kinematics_({}),
      at_rest_(VectorXd::Zero(robot.nv())),
      mixed_(robot.nv(), robot.nv()) {
  std::vector<BodyPoint> points;
  Index entry = 0;
  for (const Quantity& quantity : term_->reads()) {
    Block block = block_of(robot, quantity, contacts);
    block.entry = entry;
    block.point_row = 3 * std::ssize(points);
    points.insert(points.end(), block.points.begin(), block.points.end());
    reads_point_rates_ = reads_point_rates_ || (is_rate(quantity.kind) && is_of_frame(quantity.kind));
    if (is_of_mass(quantity.kind) && !of_mass_) of_mass_.emplace(robot);
    entry += block.size;
    blocks_.push_back(std::move(block));
  }
  kinematics_ = PointKinematics(std::move(points));
  const Index rows = term_->num_rows();
  y_.setZero(entry);
  value_.resize(rows);
  f_y_.resize(rows, entry);
  f_yy_.setZero(entry, entry);
}

TermEvaluation::Block TermEvaluation::block_of(const RobotModel& robot, const Quantity& quantity,
                                               const std::vector<int>& contacts) const {
  Block block{.kind = quantity.kind,
              .entry = 0,
              .size = size_of(quantity.kind, robot),
              .points = {},
              .point_row = 0,
              .force_row = -1,
              .variables = {},
              .slopes = {}};
  if (is_of_frame(quantity.kind)) {
    const RobotFrame frame = robot_frame(robot, quantity.name);
    if (block.size == 3) {
      block.points = {{frame.body, frame.placement.translation(), BodyPoint::Kind::point}};
    } else {
      for (const Index axis : {0, 1, 2}) {
        block.points.push_back({frame.body, frame.placement.linear().col(axis), BodyPoint::Kind::direction});
      }
    }
  } else if (quantity.kind == Kind::force) {
    const auto found = std::ranges::find(contacts, robot.contact_index(quantity.name));
    if (found != contacts.end()) block.force_row = 3 * (found - contacts.begin());
  }
  return block;
}

void TermEvaluation::lay_out(const RigidBodyTerms& kinematics, Index num_variables) {
  const Index nv = at_rest_.size(), nu = nv - 6;
  num_variables_ = num_variables;
  chains_.clear();
  Index widest = 0, tallest = 0;
  first_ = num_variables;
  last_ = 0;
  for (Block& block : blocks_) {
    block.variables.clear();
    for (const BodyPoint& point : block.points) chains_.push_back(kinematics.body_chain(point.body));
    if (block.is_identity()) {
      const Index first = block.kind == Kind::torques ? 3 * nv : block.kind == Kind::joint_rates ? nv + 6 : 6;
      for (Index i = 0; i < nu; ++i) block.variables.push_back(first + i);
    } else if (block.kind == Kind::force) {
      for (Index i = 0; block.force_row >= 0 && i < num_variables; ++i) block.variables.push_back(i);
    } else if (is_of_mass(block.kind)) {
      for (Index i = 0; i < (is_rate(block.kind) ? 2 * nv : nv); ++i) block.variables.push_back(i);
    } else if (is_of_frame(block.kind)) {
      const std::vector<int>& chain = chains_.back();  // of one body
      block.variables.assign(chain.begin(), chain.end());
      for (Index i = 0; is_rate(block.kind) && i < std::ssize(chain); ++i) block.variables.push_back(nv + chain[i]);
    }
    if (!block.is_identity()) block.slopes.setZero(block.size, std::ssize(block.variables));
    for (const Index variable : block.variables) {
      first_ = std::min(first_, variable);
      last_ = std::max(last_, variable + 1);
    }
    widest = std::max<Index>(widest, std::ssize(block.variables));
    tallest = std::max(tallest, block.size);
  }
  first_ = std::min(first_, last_);
  bent_.resize(tallest, widest);
  product_.resize(widest, widest);
  dx_.resize(term_->num_rows(), last_ - first_);
}

void TermEvaluation::check_finite(bool is_finite, const char* what) const {
  if (!is_finite) throw NumericalError(fmt::format("term '{}': {} is not finite", name_, what));
}

void TermEvaluation::read_entries(const NodeReading& at, const Block& block) {
  auto entries = y_.segment(block.entry, block.size);
  if (block.is_identity()) {
    const VectorXd& of_all = block.kind == Kind::torques ? at.tau : block.kind == Kind::joint_rates ? at.v : at.q;
    entries = of_all.tail(block.size);
  } else if (block.kind == Kind::force) {
    if (block.force_row >= 0) entries = at.forces.segment<3>(block.force_row);
  } else if (block.kind == Kind::time) {
    entries(0) = at.time;
  } else if (block.kind == Kind::center_of_mass) {
    entries = of_mass_->com();
  } else if (block.kind == Kind::center_of_mass_velocity) {
    entries = of_mass_->momentum().head<3>() / mass_;
  } else if (block.kind == Kind::angular_momentum) {
    entries = of_mass_->momentum().tail<3>();
  } else {
    const VectorXd& of_points = is_rate(block.kind) ? kinematics_.acceleration() : kinematics_.positions();
    entries = of_points.segment(block.point_row, block.size);
  }
}

void TermEvaluation::evaluate(const NodeReading& at) {
  if (num_variables_ == 0) lay_out(at.kinematics, 3 * at_rest_.size() + at.q.size() - 7);
  kinematics_.set_configuration(at.kinematics);
  if (reads_point_rates_) kinematics_.set_motion(at_rest_, at.v);  // the acceleration of a = v at rest is J v
  if (of_mass_) of_mass_->update(at.q, at.v);
  for (const Block& block : blocks_) read_entries(at, block);
  value_.setZero();
  term_->value(y_, value_);
  check_finite(value_.allFinite(), "its value");
}

void TermEvaluation::read_slopes(const MatrixXd& forces_dx, Block& block) const {
  if (block.is_identity()) return;
  if (block.kind == Kind::force) {
    if (block.force_row >= 0) block.slopes = forces_dx.middleRows<3>(block.force_row);
    return;
  }
  if (is_of_mass(block.kind)) return read_slopes_of_mass(block);
  if (!is_of_frame(block.kind)) return;
  const MatrixXd& by_q = is_rate(block.kind) ? rate_dq_ : kinematics_.positions_dq();
  const std::vector<int>& chain = chains_[block.point_row / 3];
  const Index in_v = std::ssize(chain);  // where the columns of v begin
  for (Index k = 0; k < in_v; ++k) {
    block.slopes.col(k) = by_q.col(chain[k]).segment(block.point_row, block.size);
    if (!is_rate(block.kind)) continue;
    block.slopes.col(in_v + k) = kinematics_.jacobian().col(chain[k]).segment(block.point_row, block.size);
  }
}

void TermEvaluation::read_slopes_of_mass(Block& block) const {
  const Index nv = at_rest_.size();
  if (block.kind == Kind::center_of_mass) {
    block.slopes = of_mass_->com_dq();
  } else if (block.kind == Kind::center_of_mass_velocity) {
    block.slopes.leftCols(nv) = of_mass_->momentum_dq().topRows<3>() / mass_;
    block.slopes.rightCols(nv) = of_mass_->momentum_dv().topRows<3>() / mass_;
  } else {
    block.slopes.leftCols(nv) = of_mass_->momentum_dq().bottomRows<3>();
    block.slopes.rightCols(nv) = of_mass_->momentum_dv().bottomRows<3>();
  }
}

void TermEvaluation::add_slopes(const Block& block) {
  const auto of_block = f_y_.middleCols(block.entry, block.size);
  for (Index k = 0; k < std::ssize(block.variables); ++k) {
    auto column = dx_.col(block.variables[k] - first_);
    if (block.is_identity()) {
      column += of_block.col(k);
    } else {
      column.noalias() += of_block.lazyProduct(block.slopes.col(k));
    }
  }
}

void TermEvaluation::differentiate(const MatrixXd& forces_dx) {
  const bool reads_forces = std::ranges::any_of(blocks_, [](const Block& block) { return block.force_row >= 0; });
  if (reads_forces && num_variables_ != forces_dx.cols()) {
    num_variables_ = forces_dx.cols();
    for (Block& block : blocks_) {
      if (block.force_row < 0) continue;
      block.variables.clear();
      for (Index i = 0; i < num_variables_; ++i) block.variables.push_back(i);
    }
    first_ = 0;
    last_ = num_variables_;
    bent_.resize(bent_.rows(), last_);
    product_.resize(last_, last_);
    dx_.resize(dx_.rows(), last_);
  }
  if (reads_point_rates_) kinematics_.acceleration_dq(rate_dq_);
  for (Block& block : blocks_) read_slopes(forces_dx, block);
  f_y_.setZero();
  term_->jacobian(y_, f_y_);
  clear_open_contacts();
  check_finite(f_y_.allFinite(), "its Jacobian");
  dx_.setZero();
  for (const Block& block : blocks_) add_slopes(block);
}

void TermEvaluation::clear_open_contacts() {
  for (const Block& block : blocks_) {
    if (block.kind != Kind::force || block.force_row >= 0) continue;
    f_y_.middleCols(block.entry, block.size).setZero();
    f_yy_.middleCols(block.entry, block.size).setZero();
    f_yy_.middleRows(block.entry, block.size).setZero();
  }
}

// Y_aᵀ F_ab Y_b and its transpose, of the second derivatives F in y.
void TermEvaluation::add_bending(const Block& a, const Block& b, Eigen::Ref<MatrixXd> hessian) {
  const auto bending = f_yy_.block(a.entry, b.entry, a.size, b.size);
  if (bending.isZero(0.0)) return;
  const Index rows = std::ssize(a.variables), columns = std::ssize(b.variables);
  auto bent = bent_.topLeftCorner(a.size, columns);
  if (b.is_identity()) {
    bent = bending;
  } else {
    bent.noalias() = bending * b.slopes;
  }
  auto product = product_.topLeftCorner(rows, columns);
  if (a.is_identity()) {
    product = bent;
  } else {
    product.noalias() = a.slopes.transpose() * bent;
  }
  for (Index j = 0; j < columns; ++j) {
    for (Index i = 0; i < rows; ++i) hessian(a.variables[i], b.variables[j]) += product(i, j);
  }
  if (&a == &b) return;
  for (Index j = 0; j < columns; ++j) {
    for (Index i = 0; i < rows; ++i) hessian(b.variables[j], a.variables[i]) += product(i, j);
  }
}

void TermEvaluation::add_hessian(const VectorXd& multipliers, Eigen::Ref<MatrixXd> hessian) {
  f_yy_.setZero();
  term_->hessian(y_, multipliers, f_yy_);
  clear_open_contacts();
  check_finite(f_yy_.allFinite(), "its Hessian");
  for (std::size_t a = 0; a < blocks_.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) add_bending(blocks_[a], blocks_[b], hessian);
  }
  pull_.noalias() = f_y_.transpose() * multipliers;
  if (of_mass_) add_hessian_of_mass(hessian);
  if (kinematics_.rows() == 0) return;
  on_position_.setZero(kinematics_.rows());
  on_rate_.setZero(kinematics_.rows());
  for (const Block& block : blocks_) {
    if (block.points.empty()) continue;
    VectorXd& on_points = is_rate(block.kind) ? on_rate_ : on_position_;
    on_points.segment(block.point_row, block.size) = pull_.segment(block.entry, block.size);
  }
  const Index nv = at_rest_.size();
  kinematics_.add_position_hessian(on_position_, 1.0, hessian.topLeftCorner(nv, nv));
  if (!reads_point_rates_) return;
  kinematics_.add_acceleration_hessian_qq(on_rate_, hessian.topLeftCorner(nv, nv));
  mixed_.setZero();  // the derivative of Jᵀ pull in q
  kinematics_.add_force_derivative(on_rate_, mixed_);
  hessian.block(nv, 0, nv, nv) += mixed_;
  hessian.block(0, nv, nv, nv) += mixed_.transpose();
}

void TermEvaluation::add_hessian_of_mass(Eigen::Ref<MatrixXd> hessian) {
  const Index nv = at_rest_.size();
  Eigen::Vector3d on_center = Eigen::Vector3d::Zero();
  SpatialVector on_momentum = SpatialVector::Zero();
  for (const Block& block : blocks_) {
    const auto pull = pull_.segment(block.entry, block.size);
    if (block.kind == Kind::center_of_mass) on_center += pull;
    if (block.kind == Kind::center_of_mass_velocity) on_momentum.head<3>() += pull / mass_;
    if (block.kind == Kind::angular_momentum) on_momentum.tail<3>() += pull;
  }
  mixed_.setZero();
  of_mass_->add_hessian(on_center, on_momentum, hessian.topLeftCorner(nv, nv), mixed_);
  hessian.block(0, nv, nv, nv) += mixed_;
  hessian.block(nv, 0, nv, nv) += mixed_.transpose();
}

void TermEvaluation::add_force_pull(const VectorXd& multipliers, VectorXd& pull) {
  for (const Block& block : blocks_) {
    if (block.force_row < 0) continue;
    pull.segment<3>(block.force_row).noalias() += f_y_.middleCols<3>(block.entry).transpose() * multipliers;
  }
}

}  // namespace prowl
