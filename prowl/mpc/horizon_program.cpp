#include "prowl/mpc/horizon_program.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/mpc/horizon_cost.hpp"
#include "prowl/mpc/standing_robot.hpp"
#include "prowl/transcription/node/independent_contacts.hpp"
#include "prowl/transcription/variable_units.hpp"

namespace prowl {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Entry = Eigen::SparseMatrix<double>::InnerIterator;

/// Least load of a standing contact in a horizon, as a share of its even load: a foot may nearly unload to balance, but
/// with less, feedback lifts it off (2 % and 25 % let Go2 fall when it walks).
constexpr double kMpcLeastLoad = 0.1;

/// At which dependent forces of flat feet are chosen, see set_of() [rad].
constexpr double kHeadings[] = {0.0, 0.5 * std::numbers::pi};

VectorXd turned_posture(VectorXd q, double angle) {
  set_base_rotation(q, Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix() * base_rotation(q));
  return q;
}

}  // namespace

HorizonProgram::~HorizonProgram() = default;

HorizonProgram::HorizonProgram(const RobotModel& robot, const MpcWeights& weights, double friction, int steps)
    : robot_(robot),
      nv_(robot.nv()),
      nu_(robot.nu()),
      num_contacts_(static_cast<int>(robot.contacts().size())),
      length_(robot.size()),
      feet_(contacts_of_feet(robot)),
      standing_(standing_on_ground(robot)),
      stages_(static_cast<std::size_t>(steps)) {
  make_sets(weights, friction, kHeadings[0]);
  const auto chooses = [](const ContactSet& set) { return set.num_chosen() > 0; };
  if (std::ranges::any_of(sets_, chooses)) make_sets(weights, friction, kHeadings[1]);
  const NodeFunctions& any = *sets_.back().functions;
  num_curve_rows_ = any.placement_row(0) - any.torque_row(0);
  num_rows_ = height_row(num_contacts_);
  for (ContactSet& set : sets_) {
    num_chosen_ = std::max(num_chosen_, set.num_chosen());
    for (int row = nv_; row < set.functions->num_rows(0); ++row) set.inequalities.push_back(find_inequality(set, row));
  }
  size_ = {nv_ + nu_ + num_chosen_, 2 * nv_, nv_, num_inequalities()};

  const VariableUnits unit(robot);
  const VectorXd &q = unit.q, &tau = unit.tau;
  const double time = unit.time;
  unit_.resize(size_.variables());
  unit_ << q / (time * time), tau, VectorXd::Ones(num_chosen_), q, q / time;
  row_units_.setOnes(num_inequalities());
  row_units_.head(curve_row()).setConstant(unit.force);
  for (int c = 0; c < num_contacts_; ++c)
    row_units_.segment<4>(height_row(c)) << length_, Eigen::Vector3d::Constant(length_ / time);
  row_units_.segment(position_row(0), nu_) = q.tail(nu_);
  row_units_.segment(velocity_row(0), nu_) = q.tail(nu_) / time;
  row_units_.segment(torque_row(0), nu_) = tau;

  const int all = 3 * nv_ + nu_ + num_chosen_;
  form_.setZero(all, all);
  slopes_.setZero(6 + sets_.back().functions->num_rows(0), all);
  for (ContactSet& set : sets_) {
    set.point.q = standing_;
    set.point.anchors.setZero(3 * static_cast<Index>(set.contacts.size()));
    set.on_rows.setZero(set.functions->num_rows(0));
  }
  node_.setZero(all);
  no_correction_.setZero(2 * nv_);
  on_node_.setZero(all);
  on_next_.setZero(all);
  next_.setZero(2 * nv_);
  for (int k = 0; k < steps; ++k) {
    Stage& stage = stages_[static_cast<std::size_t>(k)];
    stage.step.q_ref = standing_;
    stage.step.v_ref.setZero(nv_);
    stage.chart.setIdentity();
    stage.ux.setZero(size_.variables());
    stage.on = {VectorXd::Zero(2 * nv_), VectorXd::Zero(nv_), VectorXd::Zero(num_inequalities())};
    stage.equalities.setZero(nv_);
    stage.inequalities.setZero(num_inequalities());
    stage.link.setZero(k + 1 < steps ? 2 * nv_ : 0);
    stage.forces.setZero(3 * num_contacts_);
    set_patterns(stage, k + 1 == steps);
  }
  size_work_spaces();
}

/// At the first evaluation of each set of contacts, which must not be while the robot moves.
void HorizonProgram::size_work_spaces() {
  HorizonStep& first = stages_.front().step;
  first.length = first.contact_time = 0.1;
  for (unsigned i = 0; i < sets_.size() / num_sets(); ++i) {
    set_stage(0, turned_posture(standing_, kHeadings[i]), VectorXd::Zero(nv_), VectorXd::Zero(nv_),
              VectorXd::Zero(nu_));
    for (first.standing = 0; first.standing < num_sets(); ++first.standing) linearise(0);
  }
  first.standing = 0;
}

/// Which forces of flat feet follow from others depends on the heading: rows along the world's axes that are
/// independent at one heading are not at all others. Those of the nearer of two headings are.
HorizonProgram::ContactSet& HorizonProgram::set_of(const Stage& stage) {
  const bool is_turned = sets_.size() > num_sets() && std::abs(stage.chart(1, 0)) > std::abs(stage.chart(0, 0));
  return sets_[stage.step.standing + (is_turned ? num_sets() : 0U)];
}

void HorizonProgram::make_sets(const MpcWeights& weights, double friction, double heading) {
  const VectorXd q = turned_posture(standing_, heading);
  MotionProblem problem{
      .name = "horizon",
      .robot = robot_,
      .surfaces = {Surface{.name = "ground", .friction = friction}},
      .phases = {},
      .boundary_constraints = {BoundaryConstraint::unbounded(robot_, "start", PhaseFraction::start_of(0), standing_)},
      .running_cost = horizon_cost(robot_, weights, standing_),
      .terminal_cost = horizon_end_cost(robot_, weights, standing_),
      .goal_tolerance = {}};
  problem.friction_model = FrictionModel::pyramid;
  problem.least_load = kMpcLeastLoad;
  for (unsigned bits = 0; bits < num_sets(); ++bits) {
    ContactSet& set = sets_.emplace_back();
    Phase phase{.name = "step", .contacts = {}, .duration = {0.1, 0.1}};
    set.contacts = standing_contacts(feet_, bits);
    for (const int contact : set.contacts) phase.contacts.push_back({contact, 0});
    problem.phases = {phase};
    set.discrete = std::make_unique<DiscreteProblem>(problem, Mesh{{PhaseMesh(1)}});
    const StabilisationOfStep in_velocity{.rate = 1.0, .stiffness = 0.0};
    set.functions = std::make_unique<NodeFunctions>(*set.discrete, 0, phase_contacts(*set.discrete, 0, q), in_velocity,
                                                    PlacementKind::motion_of_contacts);
  }
}

/// Entries that a stage of any contacts has.
void HorizonProgram::set_patterns(Stage& stage, bool is_last) {
  const int inputs = size_.inputs, variables = size_.variables();
  const auto a = [](int i) { return i; };
  const auto q = [&](int i) { return inputs + i; };
  const auto v = [&](int i) { return inputs + nv_ + i; };
  std::vector<Eigen::Triplet<double>> bounds, next;
  for (int j = 0; j < nu_; ++j) {
    for (const int variable : {a(6 + j), q(6 + j), v(6 + j)}) bounds.emplace_back(variable, j, 1.0);
    for (const int variable : {a(6 + j), v(6 + j)}) bounds.emplace_back(variable, nu_ + j, 1.0);
    bounds.emplace_back(nv_ + j, 2 * nu_ + j, 1.0);
  }
  for (int i = 0; i < nv_; ++i) {
    for (int j = 0; i < 6 && j < 6; ++j) {
      for (const int variable : {a(j), q(j), v(j)}) next.emplace_back(i, variable, 1.0);
    }
    if (i >= 6) {
      for (const int variable : {a(i), q(i), v(i)}) next.emplace_back(i, variable, 1.0);
    }
    for (const int variable : {a(i), v(i)}) next.emplace_back(nv_ + i, variable, 1.0);
  }
  StageSlopes& slopes = stage.slopes;
  slopes.cost_gradient.setZero(variables);
  slopes.equalities.setZero(nv_, variables);
  slopes.hessian.setZero(variables, variables);
  slopes.rows.setZero(variables, num_rows_);
  slopes.bounds.resize(variables, 3 * nu_);
  slopes.bounds.setFromTriplets(bounds.begin(), bounds.end());
  slopes.next.resize(is_last ? 0 : 2 * nv_, variables);
  if (!is_last) slopes.next.setFromTriplets(next.begin(), next.end());
}

void HorizonProgram::use_hessian(HessianKind kind) {
  for (ContactSet& set : sets_) set.functions->use_hessian(kind);
  size_work_spaces();
}

void HorizonProgram::set_stage(int k, const VectorXd& q, const VectorXd& v, const VectorXd& a, const VectorXd& tau) {
  Stage& stage = stages_[static_cast<std::size_t>(k)];
  stage.chart = base_rotation(q);
  stage.ux.setZero();
  stage.ux.head(nv_) = a;
  stage.ux.segment(nv_, nu_) = tau;
  auto states = stage.ux.tail(2 * nv_);
  states.head<3>() = q.head<3>();
  states.segment(6, nu_) = q.tail(nu_);
  states.tail(nv_) = v;
  stage.ux.array() /= unit_.array();
}

void HorizonProgram::get_state(int k, VectorXd& q, VectorXd& v) const {
  const Stage& stage = stages_[static_cast<std::size_t>(k)];
  const auto states = stage.ux.tail(2 * nv_);
  const auto unit = unit_.tail(2 * nv_);
  q.head<3>() = states.head<3>() * length_;
  set_base_rotation(q, stage.chart * so3::exp(states.segment<3>(3)));
  q.tail(nu_) = states.segment(6, nu_).cwiseProduct(unit.segment(6, nu_));
  v = states.tail(nv_).cwiseProduct(unit.tail(nv_));
}

void HorizonProgram::get_inputs(int k, VectorXd& a, VectorXd& tau) const {
  const Stage& stage = stages_[static_cast<std::size_t>(k)];
  a = stage.ux.head(nv_).cwiseProduct(unit_.head(nv_));
  tau = stage.ux.segment(nv_, nu_).cwiseProduct(unit_.segment(nv_, nu_));
}

void HorizonProgram::to_states(int k, const VectorXd& q, const VectorXd& v, VectorXd& states) const {
  const Stage& stage = stages_[static_cast<std::size_t>(k)];
  states.resize(2 * nv_);
  states.head<3>() = q.head<3>();
  states.segment<3>(3) = so3::log(stage.chart.transpose() * base_rotation(q));
  states.segment(6, nu_) = q.tail(nu_);
  states.tail(nv_) = v;
  states.array() /= unit_.tail(2 * nv_).array();
}

int HorizonProgram::find_inequality(const ContactSet& set, int row) const {
  const NodeFunctions& functions = *set.functions;
  if (row < functions.torque_row(0)) {
    const int of_contact = (row - nv_) % FrictionLimit::kMostRows, contact = (row - nv_) / FrictionLimit::kMostRows;
    return friction_row(set.contacts[static_cast<std::size_t>(contact)]) + of_contact;
  }
  if (row < functions.placement_row(0)) return curve_row() + row - functions.torque_row(0);
  return height_row(0) + row - functions.placement_row(0);
}

void HorizonProgram::set_point(Stage& stage, ContactSet& set) {
  const int inputs = size_.inputs;
  node_.head(2 * nv_) = stage.ux.tail(2 * nv_).cwiseProduct(unit_.tail(2 * nv_));
  node_.tail(inputs) = stage.ux.head(inputs).cwiseProduct(unit_.head(inputs));
  stage.arrival.set(stage.chart, nv_, {0.5 * stage.step.length, 0.0, -1}, node_, no_correction_);
  const VectorXd& at = stage.arrival.node();
  NodePoint& point = set.point;
  point.theta = at.segment<3>(3);
  point.q.head<3>() = at.head<3>();
  set_base_rotation(point.q, stage.chart * so3::exp(point.theta));
  point.q.tail(nu_) = at.segment(6, nu_);
  point.v = at.segment(nv_, nv_);
  point.a = at.segment(2 * nv_, nv_);
  point.tau = at.segment(3 * nv_, nu_);
  point.w = at.segment(3 * nv_ + nu_, set.num_chosen());
  point.duration = stage.step.contact_time;
  point.cost_weight = stage.step.length;
}

void HorizonProgram::linearise(int k) {
  Stage& stage = stages_[static_cast<std::size_t>(k)];
  ContactSet& set = set_of(stage);
  NodeFunctions& functions = *set.functions;
  const bool is_last = k + 1 == num_stages();
  set_point(stage, set);
  set.point.terminal_weight = is_last ? 1.0 : 0.0;
  if (!is_last) {
    stage.departure.set(stage.chart, stages_[static_cast<std::size_t>(k) + 1].chart, nv_,
                        {0.5 * stage.step.length, 0.0, -1}, stage.arrival.node());
  }

  const int rows = functions.num_rows(0), columns = functions.num_columns();
  set.on_rows.resize(rows);
  set.on_rows.head(nv_) = stage.on.equalities;
  for (int row = nv_; row < rows; ++row) set.on_rows(row) = stage.on.inequalities(set.inequality_of(row, nv_));
  functions.refer_to(stage.step.q_ref, stage.step.v_ref);
  functions.linearise(set.point, 1.0, set.on_rows, set.values, set.form);
  form_.topLeftCorner(columns, columns) = set.form;
  // Sets with fewer dependent forces: the others have no effect.
  form_.bottomRows(form_.rows() - columns).setZero();
  form_.diagonal().tail(form_.rows() - columns).setOnes();

  const bool is_exact = functions.hessian_kind() == HessianKind::exact;
  on_node_.setZero();
  const auto on_bounds = stage.on.inequalities.tail(3 * nu_).cwiseQuotient(row_units_.tail(3 * nu_));
  on_node_.segment(6, nu_) = on_bounds.head(nu_);
  on_node_.segment(nv_ + 6, nu_) = on_bounds.segment(nu_, nu_);
  on_node_.segment(3 * nv_, nu_) = on_bounds.tail(nu_);
  if (!is_last) {
    on_next_.setZero();
    on_next_.head(2 * nv_) = stage.on.next.cwiseQuotient(unit_.tail(2 * nv_));
    if (is_exact) stage.departure.add_hessian(on_next_, form_);
    stage.departure.pull_back(on_next_);
    on_node_ += on_next_;
  }
  on_node_.head(columns) += set.values.cost_gradient;
  on_node_.head(columns).noalias() += set.values.rows_jacobian.transpose() * set.on_rows;
  is_exact ? stage.arrival.pull_back_hessian(form_, on_node_) : stage.arrival.pull_back_form(form_);

  const int inputs = size_.inputs, states = size_.states;
  MatrixXd& hessian = stage.slopes.hessian;
  for (int j = 0; j < inputs; ++j) {
    const double unit = unit_(j);
    hessian.col(j).segment(j, inputs - j) =
        unit * form_.col(states + j).tail(inputs - j).cwiseProduct(unit_.segment(j, inputs - j));
    hessian.col(j).tail(states) =
        unit * form_.row(states + j).head(states).transpose().cwiseProduct(unit_.tail(states));
  }
  for (int j = 0; j < states; ++j) {
    hessian.col(inputs + j).tail(states - j) =
        unit_(inputs + j) * form_.col(j).segment(j, states - j).cwiseProduct(unit_.tail(states - j));
  }
  stage.cost = set.values.cost;
  fill_values(k, set);
  fill_slopes(k, set);
}

void HorizonProgram::fill_values(int k, const ContactSet& set) {
  Stage& stage = stages_[static_cast<std::size_t>(k)];
  stage.equalities = set.values.rows.head(nv_);
  stage.inequalities.setZero();
  for (Index row = nv_; row < set.values.rows.size(); ++row)
    stage.inequalities(set.inequality_of(row, nv_)) = set.values.rows(row);
  const VectorXd& node = stage.arrival.node();
  auto bounds = stage.inequalities.tail(3 * nu_);
  bounds << node.segment(6, nu_), node.segment(nv_ + 6, nu_), node.segment(3 * nv_, nu_);
  bounds.array() /= row_units_.tail(3 * nu_).array();
  stage.forces.setZero();
  for (std::size_t i = 0; i < set.contacts.size(); ++i)
    stage.forces.segment<3>(3 * set.contacts[i]) = set.values.forces.segment<3>(static_cast<Index>(3 * i));
  if (k + 1 == num_stages()) return;
  stage.departure.value(next_);
  stage.link = next_.cwiseQuotient(unit_.tail(2 * nv_)) - stages_[static_cast<std::size_t>(k) + 1].ux.tail(2 * nv_);
}

void HorizonProgram::fill_slopes(int k, const ContactSet& set) {
  Stage& stage = stages_[static_cast<std::size_t>(k)];
  const int rows = set.functions->num_rows(0), columns = set.functions->num_columns();
  const int inputs = size_.inputs, states = size_.states;
  const bool is_last = k + 1 == num_stages();
  on_node_.setZero();
  on_node_.head(columns) = set.values.cost_gradient;
  stage.arrival.pull_back(on_node_);
  StageSlopes& slopes = stage.slopes;
  slopes.cost_gradient.head(inputs) = on_node_.tail(inputs).cwiseProduct(unit_.head(inputs));
  slopes.cost_gradient.tail(states) = on_node_.head(states).cwiseProduct(unit_.tail(states));

  // Base first: the number of rows depends on the set, and the matrix has room for the largest.
  slopes_.setZero();
  slopes_.block(6, 0, rows, columns) = set.values.rows_jacobian;
  if (!is_last) stage.departure.base_derivatives(slopes_.topRows<6>());
  stage.arrival.pull_back(slopes_);
  const auto node_variable = [&](Index i) { return i < inputs ? states + i : i - inputs; };
  slopes.rows.leftCols(curve_row()).setZero();
  for (Index j = 0; j < size_.variables(); ++j) {
    const auto column = slopes_.col(node_variable(j));
    slopes.equalities.col(j) = unit_(j) * column.segment(6, nv_);
    for (int row = nv_; row < rows; ++row) slopes.rows(j, set.inequality_of(row, nv_)) = unit_(j) * column(6 + row);
  }

  const double s = 0.5 * stage.step.length;
  for (int j = 0; j < nu_; ++j) {
    for (Entry entry(slopes.bounds, j); entry; ++entry) {
      const double slope = entry.row() < inputs ? s * s : entry.row() < inputs + nv_ ? 1.0 : s;
      entry.valueRef() = slope * unit_(entry.row()) / row_units_(position_row(j));
    }
    for (Entry entry(slopes.bounds, nu_ + j); entry; ++entry)
      entry.valueRef() = (entry.row() < inputs ? s : 1.0) * unit_(entry.row()) / row_units_(velocity_row(j));
    for (Entry entry(slopes.bounds, 2 * nu_ + j); entry; ++entry)
      entry.valueRef() = unit_(entry.row()) / row_units_(torque_row(j));
  }
  if (is_last) return;
  for (Index j = 0; j < slopes.next.outerSize(); ++j) {
    for (Entry entry(slopes.next, j); entry; ++entry) {
      const Index row = entry.row();
      double slope = 0.0;
      if (row < 6) {
        slope = slopes_(row, node_variable(j));
      } else if (row < nv_) {
        const double h = 2.0 * s;
        slope = j < inputs ? 0.5 * h * h : j < inputs + nv_ ? 1.0 : h;
      } else {
        slope = j < inputs ? 2.0 * s : 1.0;
      }
      entry.valueRef() = slope * unit_(j) / unit_(inputs + row);
    }
  }
}

}  // namespace prowl
