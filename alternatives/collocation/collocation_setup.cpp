#include <fmt/format.h>

#include <limits>
#include <map>

#include "alternatives/collocation/collocation_pieces.hpp"
#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/transcription/transcription_bounds.hpp"

// Bounds, patterns and descriptions of a Collocation; conversion of motions.

namespace prowl {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Bounds of Transcription, with the rotation in another chart.
void Collocation::set_bounds(const Trajectory& guess) {
  const int nv = problem().robot.nv(), nu = problem().robot.nu();
  const std::vector<int> no_forces(problem().phases.size(), 0), no_rows(discrete_.nodes.size(), 0);
  const DecisionLayout layout(discrete_, no_forces, no_rows);
  const VariableBounds bounds = variable_bounds(discrete_, layout);
  const std::vector<Eigen::Matrix3d> charts = rotation_charts(discrete_, guess);
  Vector3d near = Vector3d::Zero();
  for (int k = 0; k < num_nodes(); ++k) {
    const int first = node_first_[k], tau = first + (has_acceleration() ? 3 : 2) * nv;
    const auto copy = [&](int to, int from, int size) {
      variable_lower_.segment(to, size) = bounds.lower.segment(from, size);
      variable_upper_.segment(to, size) = bounds.upper.segment(from, size);
    };
    copy(first, layout.q(k), 2 * nv);
    copy(tau, layout.tau(k), nu);
    near = form_.chart->coordinates(base_rotation(guess.nodes[k].q), near);
    const Vector3d lower = bounds.lower.segment<3>(layout.q(k) + 3), upper = bounds.upper.segment<3>(layout.q(k) + 3);
    if (lower == upper) {
      const Vector3d e = form_.chart->coordinates(charts[k] * so3::exp(lower), near);
      variable_lower_.segment<3>(first + 3) = variable_upper_.segment<3>(first + 3) = e;
    } else if (lower.maxCoeff() > -std::numeric_limits<double>::infinity() ||
               upper.minCoeff() < std::numeric_limits<double>::infinity()) {
      throw InputError(discrete_.describe_moment(k) +
                       ": constrains a part of the base rotation, which this formulation cannot express");
    }
    if (middle_first_[k] < 0) continue;
    const RobotModel& robot = problem().robot;
    int middle = middle_first_[k];
    if (form_.rule->middle().state) {
      variable_lower_.segment(middle + 6, nu) = robot.position_lower();
      variable_upper_.segment(middle + 6, nu) = robot.position_upper();
      variable_lower_.segment(middle + nv + 6, nu) = -robot.velocity_limit();
      variable_upper_.segment(middle + nv + 6, nu) = robot.velocity_limit();
      middle += 2 * nv;
    }
    if (has_acceleration()) middle += nv;
    variable_lower_.segment(middle, nu) = -robot.torque_limit();
    variable_upper_.segment(middle, nu) = robot.torque_limit();
  }
  const int shared = layout.num_variables() - layout.first_shared();  // same order in both
  variable_lower_.tail(shared) = bounds.lower.tail(shared);
  variable_upper_.tail(shared) = bounds.upper.tail(shared);
}

void Collocation::set_rows() {
  std::vector<double> lower, upper;
  const auto add = [&](ProgramPiece& piece) {
    for (ProgramPiece::Rows& rows : piece.rows()) {
      rows.first = static_cast<int>(lower.size());
      lower.insert(lower.end(), rows.lower.begin(), rows.lower.end());
      upper.insert(upper.end(), rows.upper.begin(), rows.upper.end());
    }
  };
  for (const auto& node : nodes_) add(node->piece);
  for (const auto& interval : intervals_) {
    if (interval) add(interval->piece);
  }
  first_transition_row_ = static_cast<int>(lower.size());
  const auto continuity = 2 * static_cast<std::size_t>(problem().robot.nv()) * (problem().phases.size() - 1);
  lower.insert(lower.end(), continuity, 0.0);
  upper.insert(upper.end(), continuity, 0.0);
  constraint_lower_ = Eigen::Map<const VectorXd>(lower.data(), static_cast<Index>(lower.size()));
  constraint_upper_ = Eigen::Map<const VectorXd>(upper.data(), static_cast<Index>(upper.size()));
}

void Collocation::set_patterns() {
  std::map<std::pair<int, int>, int> indices;
  const auto add = [&](ProgramPiece& piece, std::vector<HessianEntry>& own) {
    piece.visit_jacobian(true, [&](int row, int col, double) {
      jacobian_pattern_.rows.push_back(row);
      jacobian_pattern_.cols.push_back(col);
    });
    const ProgramGraph::Pattern pattern = piece.graph.hessian_pattern();
    for (int i = 0; i < pattern.rows(); ++i) {
      for (int j = 0; j < pattern.cols(); ++j) {
        const int row = piece.columns()[i], col = piece.columns()[j];
        if (pattern(i, j) == 0.0F || row < col) continue;
        const auto [found, is_new] = indices.insert({{row, col}, hessian_pattern_.size()});
        if (is_new) {
          hessian_pattern_.rows.push_back(row);
          hessian_pattern_.cols.push_back(col);
        }
        own.push_back({i, j, found->second});
      }
    }
  };
  for (const auto& node : nodes_) add(node->piece, node->entries);
  for (const auto& interval : intervals_) {
    if (!interval) continue;
    // Second derivatives of accelerations at the ends are in the node's pieces.
    add(interval->piece, interval->entries);
  }
  int row = first_transition_row_;
  for (int k = 0; k + 1 < num_nodes(); ++k) {
    if (is_interval(k)) continue;
    for (int i = 0; i < 2 * problem().robot.nv(); ++i, ++row) {
      for (const int end : {0, 1}) {
        jacobian_pattern_.rows.push_back(row);
        jacobian_pattern_.cols.push_back(node_first_[k + end] + i);
      }
    }
  }
}

void Collocation::write_point(const TrajectoryPoint& point, int k, int first, bool state, const Vector3d& near,
                              VectorXd& z) const {
  const int nv = problem().robot.nv(), nu = problem().robot.nu();
  if (state) {
    z.segment<3>(first) = base_position(point.q);
    z.segment<3>(first + 3) = form_.chart->coordinates(base_rotation(point.q), near);
    z.segment(first + 6, nu) = point.q.tail(nu);
    z.segment(first + nv, nv) = point.v;
    first += 2 * nv;
  }
  if (has_acceleration()) {
    z.segment(first, nv) = point.a;
    first += nv;
  }
  z.segment(first, nu) = point.tau;
  first += nu;
  for (const int row : charted(k).functions().chosen_rows()) {
    const int contact = charted(k).functions().contacts()[row / 3];
    z(first++) = point.force(3 * contact + row % 3);
  }
}

VectorXd Collocation::pack(const Trajectory& trajectory) const {
  VectorXd z(num_variables());
  Vector3d near = Vector3d::Zero();
  for (int k = 0; k < num_nodes(); ++k) {
    const TrajectoryPoint& point = trajectory.nodes[k];
    write_point(point, k, node_first_[k], true, near, z);
    near = z.segment<3>(node_first_[k] + 3);
    if (middle_first_[k] < 0) continue;
    const double middle = 0.5 * (point.time + trajectory.nodes[k + 1].time);
    write_point(sample(trajectory, middle), k, middle_first_[k], form_.rule->middle().state, near, z);
  }
  for (std::size_t p = 0; p < durations_.size(); ++p) {
    if (durations_[p] >= 0) z(durations_[p]) = planned_duration(trajectory, static_cast<int>(p));
  }
  const std::vector<Eigen::Vector2d> footholds = landing_footholds(trajectory);
  for (std::size_t s = 0; s < footholds.size(); ++s) {
    if (footholds_[s] >= 0) z.segment<2>(footholds_[s]) = footholds[s];
  }
  return z;
}

Trajectory Collocation::unpack(const VectorXd& z) {
  evaluate(z, false);
  const int nv = problem().robot.nv(), nu = problem().robot.nu();
  Trajectory trajectory;
  trajectory.interpolation = Interpolation::hermite;
  double phase_start = 0.0;
  for (int k = 0; k < num_nodes(); ++k) {
    const PointFunction& dynamics = *nodes_[k]->dynamics;
    const VectorXd& columns = dynamics.columns();
    TrajectoryPoint point;
    point.time = node_time(k, duration(z, phase_of(k), durations_[phase_of(k)]), phase_start);
    point.phase = phase_of(k);
    point.q = charted(k).configuration(columns);
    point.v = columns.segment(nv, nv);
    point.a = columns.segment(2 * nv, nv);
    point.tau = columns.segment(3 * nv, nu);
    point.force.setZero(3 * static_cast<Index>(problem().robot.contacts().size()));
    const std::vector<int>& contacts = charted(k).functions().contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      point.force.segment<3>(3 * contacts[i]) = dynamics.forces().segment<3>(static_cast<Index>(3 * i));
    }
    append(std::move(point), trajectory);
    if (middle_first_[k] < 0) continue;
    const int skipped = (form_.rule->middle().state ? 2 * nv : 0) + (has_acceleration() ? nv : 0);
    trajectory.middle_torques.push_back(z.segment(middle_first_[k] + skipped, nu));
  }
  return trajectory;
}

std::string Collocation::describe_constraint(int row) const {
  const auto name_in = [row](const ProgramPiece& piece) -> const std::string* {
    for (const ProgramPiece::Rows& rows : piece.rows()) {
      if (row >= rows.first && row < rows.first + rows.lower.size()) return &rows.names[row - rows.first];
    }
    return nullptr;
  };
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const std::string* name = name_in(nodes_[k]->piece);
    if (!name && k < intervals_.size() && intervals_[k]) name = name_in(intervals_[k]->piece);
    if (name) return discrete_.describe_moment(static_cast<int>(k)) + ", " + *name;
  }
  const int nv = problem().robot.nv(), i = (row - first_transition_row_) % (2 * nv);
  int to_go = (row - first_transition_row_) / (2 * nv), k = 0;
  while (is_interval(k) || to_go-- > 0) ++k;
  return fmt::format("{}, {}, {} across the phase transition", discrete_.describe_moment(k),
                     charted(k).describe_coordinate(i % nv), i < nv ? "position" : "velocity");
}

std::string Collocation::describe_variable(int index) const {
  const int nv = problem().robot.nv(), nu = problem().robot.nu();
  for (std::size_t p = 0; p < durations_.size(); ++p) {
    if (durations_[p] == index) return fmt::format("phase {} '{}', duration", p + 1, problem().phases[p].name);
  }
  for (std::size_t s = 0; s < footholds_.size(); ++s) {
    if (footholds_[s] < 0 || (index != footholds_[s] && index != footholds_[s] + 1)) continue;
    const int contact = discrete_.schedule.stances()[s].contact;
    return fmt::format("foothold coordinate {} of {}", index - footholds_[s] + 1,
                       problem().robot.contacts()[contact].name);
  }
  int k = num_nodes() - 1;
  while (node_first_[k] > index) --k;
  const int middle = middle_first_[k];
  const bool inside = middle >= 0 && index >= middle;
  int i = index - (inside ? middle : node_first_[k]);
  if (inside && !form_.rule->middle().state) i += 2 * nv;
  if (!has_acceleration() && i >= 2 * nv) i += nv;
  constexpr const char* kKinds[] = {"position", "velocity", "acceleration"};
  const std::string what = i < 3 * nv ? fmt::format("{} {}", kKinds[i / nv], charted(k).describe_coordinate(i % nv))
                           : i < 3 * nv + nu ? "torque " + problem().robot.joint_names()[i - 3 * nv]
                                             : fmt::format("force {}", i - 3 * nv - nu + 1);
  return fmt::format("{}{}, {}", discrete_.describe_moment(k), inside ? ", in the interval after it" : "", what);
}

}  // namespace prowl
