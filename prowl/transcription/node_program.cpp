#include "prowl/transcription/node_program.hpp"

#include <algorithm>
#include <utility>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/transcription/phase_setup.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<std::vector<NodeFunctions>> one_thread(std::vector<NodeFunctions> functions) {
  std::vector<std::vector<NodeFunctions>> threads;
  threads.push_back(std::move(functions));
  return threads;
}

DecisionLayout layout_of(const DiscreteProblem& discrete, const std::vector<NodeFunctions>& phases) {
  std::vector<int> sizes_of_w, rows_of_nodes;
  for (const NodeFunctions& phase : phases) sizes_of_w.push_back(static_cast<int>(phase.chosen_rows().size()));
  for (const MeshNode& node : discrete.nodes) rows_of_nodes.push_back(phases[node.phase].num_rows(node.node));
  return {discrete, sizes_of_w, rows_of_nodes};
}

}  // namespace

std::vector<NodeFunctions> NodeProgram::functions_of_phases() const {
  std::vector<NodeFunctions> functions;
  for (std::size_t p = 0; p < contacts_.size(); ++p)
    functions.emplace_back(discrete_, static_cast<int>(p), contacts_[p]);
  return functions;
}

NodeProgram::NodeProgram(const DiscreteProblem& discrete, const Trajectory& guess, Corrections corrections)
    : discrete_(discrete),
      contacts_(contacts_of_phases(discrete, guess)),
      functions_(one_thread(functions_of_phases())),
      anchor_origins_(anchor_origins(discrete)),
      layout_(layout_of(discrete, functions_.front())),
      bounds_(variable_bounds(discrete, layout_)),
      charts_(rotation_charts(discrete, guess)),
      corrections_(std::move(corrections)),
      none_(VectorXd::Zero(2 * discrete.problem.robot.nv())) {
  for (int p = 0; p < static_cast<int>(contacts_.size()); ++p) {
    std::vector<int>& shared = shared_.emplace_back();
    if (layout_.duration(p) >= 0) shared.push_back(layout_.duration(p));
    for (const int i : functions_.front()[p].landed()) {
      const int foothold = layout_.foothold(discrete.schedule.stance(p, i));
      shared.insert(shared.end(), {foothold, foothold + 1});
    }
  }
}

int NodeProgram::column(int k, int j) const {
  const int own = layout_.node_size(k);
  return j < own ? layout_.node(k) + j : shared_[phase_of(k)][j - own];
}

VectorXd NodeProgram::variables(int k, const VectorXd& z) const {
  VectorXd node(functions(k).num_columns());
  for (Index j = 0; j < node.size(); ++j) node(j) = z(column(k, static_cast<int>(j)));
  return node;
}

void NodeProgram::set_point(int k, const VectorXd& variables, NodePoint& point) const {
  const int nv = layout_.nv(), nu = layout_.nu();
  const MeshNode& mesh_node = discrete_.nodes[k];
  const PhaseMesh& mesh = discrete_.phase_mesh_of(k);
  const Phase& phase = discrete_.phase_of(k);
  point.node = mesh_node.node;
  point.theta = variables.segment<3>(3);
  point.q.resize(nv + 1);
  point.q.head<3>() = variables.head<3>();
  set_base_rotation(point.q, charts_[k] * so3::exp(point.theta));
  point.q.tail(nu) = variables.segment(6, nu);
  point.v = variables.segment(nv, nv);
  point.a = variables.segment(2 * nv, nv);
  point.tau = variables.segment(3 * nv, nu);
  point.w = variables.segment(3 * nv + nu, layout_.num_w(k));
  Index shared = layout_.node_size(k);
  point.duration = functions(k).has_free_duration() ? variables(shared++) : phase.duration.min;
  point.anchors = anchor_origins_[mesh_node.phase];
  for (const int i : functions(k).landed()) {
    const Surface& surface = discrete_.problem.surfaces[phase.contacts[i].surface];
    point.anchors.segment<3>(3 * i) += surface.axes() * variables.segment<2>(shared);
    shared += 2;
  }
  const double step_in = mesh_node.h_in > 0.0 ? mesh.step(point.node - 1, point.duration) : 0.0;
  const double step_out = mesh_node.h_out > 0.0 ? mesh.step(point.node, point.duration) : 0.0;
  point.cost_weight = 0.5 * (step_in + step_out);
  point.terminal_weight = k + 1 == num_nodes() ? 1.0 : 0.0;
}

void NodeProgram::use_threads(int count) {
  const HessianKind hessian = hessian_kind();
  functions_.resize(std::min(static_cast<std::size_t>(count), functions_.size()));
  while (static_cast<int>(functions_.size()) < count) functions_.push_back(functions_of_phases());
  use_hessian(hessian);
}

void NodeProgram::use_hessian(HessianKind kind) {
  for (std::vector<NodeFunctions>& phases : functions_) {
    for (NodeFunctions& functions : phases) functions.use_hessian(kind);
  }
}

}  // namespace prowl
