#include "alternatives/collocation/collocation.hpp"

#include <fmt/format.h>

#include <limits>
#include <numeric>

#include "alternatives/collocation/collocation_pieces.hpp"
#include "prowl/error.hpp"
#include "prowl/transcription/phase_setup.hpp"

namespace prowl {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// All forces are variables: no row of J remains for the projection.
std::vector<int> all_rows(const Phase& phase) {
  std::vector<int> rows(3 * phase.contacts.size());
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

StabilisationOfStep gains(const CollocationForm& form) {
  return form.contact.stabilised ? form.rule->stabilisation() : StabilisationOfStep{0.0, 0.0};
}

}  // namespace

Collocation::Collocation(const DiscreteProblem& discrete, const Trajectory& guess, CollocationForm form)
    : MotionNlp(discrete), form_(std::move(form)) {
  if (form_.rule->is_explicit() && has_acceleration()) {
    throw InputError("transcription: " + form_.rule->name() +
                     " needs dynamics = \"forward\": it evaluates accelerations");
  }
  for (std::size_t p = 0; p < problem().phases.size(); ++p) {
    const double step = problem().phases[p].duration.max / discrete.mesh.phases[p].intervals();
    if (!form_.contact.stabilised || step <= form_.rule->longest_stabilised_step()) continue;
    throw InputError(fmt::format(
        "transcription: {} cannot keep contacts over steps of {:.3g} s; need at most {} s, or another contact form",
        form_.rule->name(), step, form_.rule->longest_stabilised_step()));
  }
  const std::vector<VectorXd> origins = anchor_origins(discrete);
  std::vector<PhaseContacts> contacts = contacts_of_phases(discrete, guess);
  for (std::size_t p = 0; p < problem().phases.size(); ++p) {
    const int phase = static_cast<int>(p);
    if (!contacts[p].chosen_rows.empty() && !form_.contact.stabilised) {
      throw InputError("contact: \"" + form_.contact.name + "\" needs contacts that are not redundant");
    }
    if (!contacts[p].chosen_rows.empty() && form_.dynamics->has_forces()) {
      throw InputError("dynamics: \"" + form_.dynamics_name + "\" needs contacts that are not redundant");
    }
    if (form_.dynamics->has_forces()) contacts[p].chosen_rows = all_rows(problem().phases[p]);
    const ContactRows rows(problem(), phase,
                           {.distance = form_.contact.distance,
                            .velocity = form_.contact.velocity,
                            .acceleration = form_.contact.acceleration || form_.dynamics->has_forces(),
                            .tolerance = form_.contact.tolerance});
    charted_.push_back(
        std::make_unique<ChartedNode>(discrete, phase, contacts[p], gains(form_), rows, *form_.chart, origins[p]));
  }
  make_layout();
  for (int k = 0; k < num_nodes(); ++k) make_node(k);
  for (int k = 0; k + 1 < num_nodes(); ++k) {
    intervals_.emplace_back();
    if (is_interval(k)) make_interval(k);
  }
  set_bounds(guess);
  set_rows();
  set_patterns();
}

Collocation::~Collocation() = default;

int Collocation::point_size(int k, bool state) const {
  const int nv = problem().robot.nv(), forces = static_cast<int>(charted(k).functions().chosen_rows().size());
  return (state ? 2 * nv : 0) + (has_acceleration() ? nv : 0) + problem().robot.nu() + forces;
}

void Collocation::make_layout() {
  const CollocationRule::Middle middle = form_.rule->middle();
  int next = 0;
  for (int k = 0; k < num_nodes(); ++k) {
    node_first_.push_back(next);
    next += point_size(k, true);
    const bool has_middle = is_interval(k) && middle.inputs;
    middle_first_.push_back(has_middle ? next : -1);
    if (has_middle) next += point_size(k, middle.state);
  }
  for (const Phase& phase : problem().phases) durations_.push_back(phase.duration.is_fixed() ? -1 : next++);
  for (const ContactStance& stance : discrete_.schedule.stances()) {
    footholds_.push_back(stance.lands() ? next : -1);
    if (stance.lands()) next += 2;
  }
  variable_lower_.setConstant(next, -std::numeric_limits<double>::infinity());
  variable_upper_.setConstant(next, std::numeric_limits<double>::infinity());
}

std::vector<int> Collocation::columns(int first, int size) const {
  std::vector<int> columns(static_cast<std::size_t>(size));
  std::iota(columns.begin(), columns.end(), first);
  return columns;
}

std::vector<int> Collocation::shared_columns(int k) const {
  const int phase = mesh_node(k).phase;
  std::vector<int> columns;
  if (durations_[phase] >= 0) columns.push_back(durations_[phase]);
  for (const int contact : charted(k).functions().landed()) {
    const int foothold = footholds_[discrete_.schedule.stance(phase, contact)];
    columns.insert(columns.end(), {foothold, foothold + 1});
  }
  return columns;
}

StepSize Collocation::step(int k, int first_shared) const {
  const Duration& duration = discrete_.phase_of(k).duration;
  const int intervals = discrete_.phase_mesh_of(k).intervals();
  if (duration.is_fixed()) return {.fixed = duration.min / intervals};
  return {.variable = first_shared, .share = 1.0 / intervals};
}

/// From local variable `first` on.
IntervalProgram::Point Collocation::variables(ProgramGraph& graph, int k, int first, bool state) const {
  const int nv = problem().robot.nv(), nu = problem().robot.nu();
  IntervalProgram::Point point;
  if (state) {
    point.x = graph.variables(first, nv);
    point.v = graph.variables(first + nv, nv);
    first += 2 * nv;
  }
  if (has_acceleration()) {
    point.acceleration = graph.variables(first, nv);
    first += nv;
  }
  point.tau = graph.variables(first, nu);
  point.w = graph.variables(first + nu, static_cast<int>(charted(k).functions().chosen_rows().size()));
  return point;
}

void Collocation::make_node(int k) {
  const int nv = problem().robot.nv(), own = point_size(k, true);
  std::vector<int> columns = this->columns(node_first_[k], own);
  const std::vector<int> shared = shared_columns(k);
  columns.insert(columns.end(), shared.begin(), shared.end());
  auto node = std::make_unique<NodePiece>(NodePiece{ProgramPiece(columns, step(k, own))});
  ProgramPiece& piece = node->piece;
  const IntervalProgram::Point point = variables(piece.graph, k, 0, true);

  const MeshNode& at = mesh_node(k);
  ChartedNode& charted = this->charted(k);
  std::vector<int> rows;
  for (int row = has_acceleration() ? 0 : nv; row < charted.num_rows(at.node); ++row) {
    // At the first node of a phase, distances and velocities of contacts are determined by the
    // start, the end of the phase before, or the landing.
    const int contact_row = row - charted.functions().num_rows(at.node);
    if (at.node == 0 && contact_row >= 0 && contact_row < charted.contact_rows().first_acceleration()) continue;
    rows.push_back(row);
  }
  const double share =
      (at.h_in > 0.0 ? form_.rule->right_share() : 0.0) + (at.h_out > 0.0 ? form_.rule->left_share() : 0.0);
  const Instant instant{.node = at.node, .cost_share = share, .terminal_weight = k + 1 == num_nodes() ? 1.0 : 0.0};
  PointFunction& dynamics = piece.own(form_.dynamics->at(charted, instant, std::move(rows)));
  std::vector<ProgramGraph::Vector> inputs = {point.x, point.v};
  if (has_acceleration()) inputs.push_back(point.acceleration);
  for (const auto& input : {point.tau, point.w, piece.graph.variables(own, static_cast<int>(shared.size()))})
    inputs.push_back(input);
  const ProgramGraph::Vector all = piece.graph.call(dynamics, inputs);
  node->dynamics = &dynamics;
  node->acceleration = has_acceleration() ? point.acceleration : piece.graph.slice(all, 0, nv);
  piece.add_cost(piece.graph.slice(all, dynamics.num_outputs() - 1, 1));

  const auto count = static_cast<Index>(dynamics.rows().size());
  ProgramPiece::Rows held{piece.graph.slice(all, dynamics.acceleration_size(), static_cast<int>(count)),
                          VectorXd(count),
                          VectorXd(count),
                          {}};
  for (Index i = 0; i < count; ++i) {
    const int row = dynamics.rows()[i];
    held.lower(i) = charted.lower(at.node, row);
    held.upper(i) = charted.upper(at.node, row);
    held.names.push_back(charted.describe_row(at.node, row));
  }
  piece.add_rows(std::move(held));
  nodes_.push_back(std::move(node));
}

void Collocation::make_interval(int k) {
  const int nv = problem().robot.nv(), own = point_size(k, true);
  const CollocationRule::Middle middle = form_.rule->middle();
  const int middle_size = middle.inputs ? point_size(k, middle.state) : 0;
  // Node, middle and node are adjacent among the decision variables.
  std::vector<int> columns = this->columns(node_first_[k], 2 * own + middle_size);
  const std::vector<int> shared = shared_columns(k);
  const int first_shared = static_cast<int>(columns.size());
  columns.insert(columns.end(), shared.begin(), shared.end());
  auto interval = std::make_unique<IntervalPiece>(IntervalPiece{ProgramPiece(columns, step(k, first_shared))});
  ProgramGraph& graph = interval->piece.graph;

  IntervalProgram program(interval->piece, charted(k), *form_.dynamics,
                          graph.variables(first_shared, static_cast<int>(shared.size())));
  program.left = variables(graph, k, 0, true);
  program.right = variables(graph, k, own + middle_size, true);
  if (middle.inputs) program.middle = variables(graph, k, own, middle.state);
  for (const int end : {0, 1}) {
    IntervalProgram::Point& point = end == 0 ? program.left : program.right;
    point.rate = graph.call(interval->piece.own(std::make_unique<RateFunction>(*form_.chart, nv)), {point.x, point.v});
    if (has_acceleration()) continue;
    const NodePiece& node = *nodes_[k + end];
    IntervalPiece::Link link{.here = {}, .there = node.acceleration, .node = k + end, .columns = {}};
    const int first = end == 0 ? 0 : own + middle_size;
    for (int j = 0; j < node.piece.graph.num_locals(); ++j) {
      link.columns.push_back(j < own ? first + j : first_shared + j - own);
    }
    const ProgramGraph::Pattern& there = node.piece.graph.pattern(node.acceleration);
    ProgramGraph::Pattern here = ProgramGraph::Pattern::Zero(nv, graph.num_locals());
    for (std::size_t j = 0; j < link.columns.size(); ++j) here.col(link.columns[j]) = there.col(static_cast<Index>(j));
    link.here = point.acceleration = graph.outside(nv, std::move(here));
    interval->links.push_back(std::move(link));
  }
  form_.rule->add_to(program);
  intervals_[k] = std::move(interval);
}

template <class Visit>
void Collocation::for_each_piece(Visit visit) const {
  for (const auto& node : nodes_) visit(node->piece);
  for (const auto& interval : intervals_) {
    if (interval) visit(interval->piece);
  }
}

void Collocation::evaluate_all(const VectorXd& z, bool with_derivatives) {
  const auto locals = [&z](const ProgramPiece& piece) {
    VectorXd values(static_cast<Index>(piece.columns().size()));
    for (Index j = 0; j < values.size(); ++j) values(j) = z(piece.columns()[j]);
    return values;
  };
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    try {
      nodes_[k]->piece.graph.evaluate(locals(nodes_[k]->piece), with_derivatives);
    } catch (const NumericalError& error) {
      throw NumericalError(discrete_.describe_moment(static_cast<int>(k)) + ": " + error.what());
    }
  }
  for (std::size_t k = 0; k < intervals_.size(); ++k) {
    if (!intervals_[k]) continue;
    ProgramGraph& graph = intervals_[k]->piece.graph;
    for (const IntervalPiece::Link& link : intervals_[k]->links) {
      const ProgramGraph& there = nodes_[link.node]->piece.graph;
      graph.set_outside(link.here, there.value(link.there));
      if (!with_derivatives) continue;
      Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(there.size(link.there), graph.num_locals());
      for (std::size_t j = 0; j < link.columns.size(); ++j) {
        derivative.col(link.columns[j]) += there.derivative(link.there).col(static_cast<Index>(j));
      }
      graph.set_outside_derivative(link.here, derivative);
    }
    try {
      graph.evaluate(locals(intervals_[k]->piece), with_derivatives);
    } catch (const NumericalError& error) {
      throw NumericalError(discrete_.describe_moment(static_cast<int>(k)) +
                           ", in the interval after it: " + error.what());
    }
  }
}

double Collocation::cost(const VectorXd& z) {
  evaluate(z, false);
  double total = 0.0;
  for_each_piece([&](const ProgramPiece& piece) {
    for (const ProgramGraph::Vector cost : piece.costs()) total += piece.graph.value(cost)(0);
  });
  return total;
}

void Collocation::cost_gradient(const VectorXd& z, Eigen::Ref<VectorXd> gradient) {
  evaluate(z, true);
  gradient.setZero();
  for_each_piece([&](const ProgramPiece& piece) {
    for (const ProgramGraph::Vector cost : piece.costs()) {
      const auto slope = piece.graph.derivative(cost).row(0);
      for (std::size_t j = 0; j < piece.columns().size(); ++j)
        gradient(piece.columns()[j]) += slope(static_cast<Index>(j));
    }
  });
}

void Collocation::constraints(const VectorXd& z, Eigen::Ref<VectorXd> g) {
  evaluate(z, false);
  for_each_piece([&](const ProgramPiece& piece) {
    for (const ProgramPiece::Rows& rows : piece.rows())
      g.segment(rows.first, rows.lower.size()) = piece.graph.value(rows.vector);
  });
  const int state = 2 * problem().robot.nv();
  int row = first_transition_row_;
  for (int k = 0; k + 1 < num_nodes(); ++k) {
    if (is_interval(k)) continue;
    g.segment(row, state) = z.segment(node_first_[k + 1], state) - z.segment(node_first_[k], state);
    row += state;
  }
}

void Collocation::jacobian(const VectorXd& z, Eigen::Ref<VectorXd> values) {
  evaluate(z, true);
  Index next = 0;
  for_each_piece([&](const ProgramPiece& piece) {
    piece.visit_jacobian(false, [&](int, int, double value) { values(next++) = value; });
  });
  while (next < values.size()) {  // phase transitions
    values(next++) = -1.0;
    values(next++) = 1.0;
  }
}

void Collocation::hessian(const VectorXd& z, double cost_factor, const VectorXd& multipliers,
                          Eigen::Ref<VectorXd> values) {
  evaluate(z, true);
  const bool exact = hessian_kind_ == HessianKind::exact;
  const auto set_weights = [&](ProgramPiece& piece) {
    piece.graph.clear_weights();
    for (const ProgramGraph::Vector cost : piece.costs()) piece.graph.weights(cost)(0) = cost_factor;
    if (!exact) return;
    for (const ProgramPiece::Rows& rows : piece.rows()) {
      piece.graph.weights(rows.vector) += multipliers.segment(rows.first, rows.lower.size());
    }
  };
  for (const auto& node : nodes_) set_weights(node->piece);
  for (const auto& interval : intervals_) {
    if (!interval) continue;
    ProgramGraph& graph = interval->piece.graph;
    set_weights(interval->piece);
    interval->hessian.setZero(graph.num_locals(), graph.num_locals());
    graph.add_hessian(interval->hessian);
    for (const IntervalPiece::Link& link : interval->links) {
      nodes_[link.node]->piece.graph.weights(link.there) += graph.weights(link.here);
    }
  }
  for (const auto& node : nodes_) {
    ProgramGraph& graph = node->piece.graph;
    node->hessian.setZero(graph.num_locals(), graph.num_locals());
    graph.add_hessian(node->hessian);
  }
  values.setZero();
  const auto add = [&values](const std::vector<HessianEntry>& entries, const Eigen::MatrixXd& from) {
    for (const auto& [row, col, index] : entries) values(index) += from(row, col);
  };
  for (const auto& node : nodes_) add(node->entries, node->hessian);
  for (const auto& interval : intervals_) {
    if (interval) add(interval->entries, interval->hessian);
  }
}

void Collocation::use_hessian(HessianKind kind) {
  hessian_kind_ = kind;
  for (const auto& charted : charted_) charted->use_hessian(kind);
}

}  // namespace prowl
