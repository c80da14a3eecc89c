#include "prowl/transcription/motion_limits.hpp"

#include <cmath>
#include <map>
#include <utility>

namespace prowl {

namespace {

using Eigen::VectorXd;

bool binds(const VectorXd& lower, const VectorXd& upper, int i) {
  return std::isfinite(lower(i)) || std::isfinite(upper(i));
}

/// Limits of the goals and of standing at the end, by decision variable.
std::map<int, MotionLimit> limits_of_goals(const DiscreteProblem& discrete, const DecisionLayout& layout) {
  const MotionProblem& problem = discrete.problem;
  const RobotModel& robot = problem.robot;
  std::map<int, MotionLimit> limits;
  for (std::size_t c = 1; c < problem.boundary_constraints.size(); ++c) {
    const BoundaryConstraint& goal = problem.boundary_constraints[c];
    const int k = discrete.boundary_nodes[c];
    for (int i = 0; i < layout.nv(); ++i) {
      if (binds(goal.configuration_lower, goal.configuration_upper, i))
        limits.insert_or_assign(layout.q(k) + i, limit_of_goal(robot, goal.name, i, false));
      if (binds(goal.velocity_lower, goal.velocity_upper, i))
        limits.insert_or_assign(layout.v(k) + i, limit_of_goal(robot, goal.name, i, true));
    }
    for (int j = 0; j < layout.nu(); ++j) {
      if (!binds(goal.torque_lower, goal.torque_upper, j)) continue;
      MotionLimit limit = limit_of_joint(robot, LimitKind::torque, j);
      limit.kind = LimitKind::goal;
      limit.subject = goal.name + ", torque of " + limit.subject;
      limits.insert_or_assign(layout.tau(k) + j, limit);
    }
  }
  if (!problem.stands_at_end) return limits;
  for (int i = 0; i < 6; ++i) {
    limits.insert_or_assign(layout.a(layout.num_nodes() - 1) + i, limit_of_standing(robot, i));
  }
  return limits;
}

}  // namespace

std::vector<MotionLimit> motion_limits(const NodeProgram& program) {
  const DiscreteProblem& discrete = program.discrete();
  const DecisionLayout& layout = program.layout();
  const RobotModel& robot = discrete.problem.robot;
  const std::map<int, MotionLimit> of_goals = limits_of_goals(discrete, layout);
  std::vector<MotionLimit> result;
  const auto add = [&](MotionLimit limit, bool is_row, int index, int k, double lower, double upper) {
    if (!std::isfinite(lower) && !std::isfinite(upper)) return;
    limit.is_row = is_row;
    limit.index = index;
    limit.node = k;
    limit.phase = program.phase_of(k);
    result.push_back(std::move(limit));
  };
  const auto add_variable = [&](MotionLimit limit, int variable, int k) {
    add(std::move(limit), false, variable, k, program.bounds().lower(variable), program.bounds().upper(variable));
  };
  for (int k = 0; k < program.num_nodes(); ++k) {
    const NodeFunctions& functions = program.functions(k);
    const int node = discrete.nodes[k].node;
    for (int row = 0; row < program.num_rows(k); ++row) {
      const auto limit = functions.limit_of_row(robot, node, row);
      if (limit) add(*limit, true, layout.node_row(k) + row, k, functions.lower(node, row), functions.upper(node, row));
    }
    const auto add_base = [&](int variable) {
      if (const auto goal = of_goals.find(variable); goal != of_goals.end()) add_variable(goal->second, variable, k);
    };
    const auto add_joint = [&](LimitKind kind, int joint, int variable) {
      const auto goal = of_goals.find(variable);
      add_variable(goal == of_goals.end() ? limit_of_joint(robot, kind, joint) : goal->second, variable, k);
    };
    const bool is_start = k == 0;  // fixed, or bounded by its own condition
    for (int i = 0; i < 6 && !is_start; ++i) {
      add_base(layout.q(k) + i);
      add_base(layout.v(k) + i);
      add_base(layout.a(k) + i);
    }
    for (int j = 0; j < layout.nu(); ++j) {
      if (!is_start) {
        add_joint(LimitKind::joint_position, j, layout.q(k) + 6 + j);
        add_joint(LimitKind::joint_velocity, j, layout.v(k) + 6 + j);
      }
      add_joint(LimitKind::torque, j, layout.tau(k) + j);
    }
  }
  const std::vector<ContactStance>& stances = discrete.schedule.stances();
  for (int s = 0; s < static_cast<int>(stances.size()); ++s) {
    if (!stances[s].lands() || !stances[s].foothold) continue;
    const MotionLimit limit{.kind = LimitKind::foothold,
                            .subject = robot.contacts()[stances[s].contact].name,
                            .unit = "m",
                            .size = robot.size()};
    const int k = discrete.mesh.first_node(stances[s].first_phase);
    for (const int axis : {0, 1}) add_variable(limit, layout.foothold(s) + axis, k);
  }
  return result;
}

}  // namespace prowl
