#include <limits>
#include <map>

#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<MotionLimit> Transcription::limits() const {
  const RobotModel& robot = problem_.robot;
  const int nv = layout_.nv(), nu = layout_.nu();
  std::vector<MotionLimit> result;
  const auto add = [&](MotionLimit limit, bool is_row, int index, int k) {
    const auto& lower = is_row ? constraint_lower_ : variable_lower_;
    const auto& upper = is_row ? constraint_upper_ : variable_upper_;
    if (lower(index) == -kInfinity && upper(index) == kInfinity) return;
    limit.is_row = is_row;
    limit.index = index;
    limit.node = k;
    limit.phase = phase_of(k);
    result.push_back(std::move(limit));
  };

  std::map<int, MotionLimit> of_goals;  // by variable
  for (std::size_t c = 1; c < problem_.boundary_conditions.size(); ++c) {
    const BoundaryCondition& goal = problem_.boundary_conditions[c];
    const int k = mesh_.index(goal.at);
    const auto binds = [](const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, int i) {
      return lower(i) > -kInfinity || upper(i) < kInfinity;
    };
    for (int i = 0; i < nv; ++i) {
      if (binds(goal.configuration_lower, goal.configuration_upper, i))
        of_goals.insert_or_assign(layout_.q(k) + i, limit_of_goal(robot, goal.name, i, false));
      if (binds(goal.velocity_lower, goal.velocity_upper, i))
        of_goals.insert_or_assign(layout_.v(k) + i, limit_of_goal(robot, goal.name, i, true));
    }
    for (int j = 0; j < nu; ++j) {
      if (!binds(goal.torque_lower, goal.torque_upper, j)) continue;
      MotionLimit limit = limit_of_joint(robot, LimitKind::torque, j);
      limit.kind = LimitKind::goal;
      limit.subject = goal.name + ", torque of " + limit.subject;
      of_goals.insert_or_assign(layout_.tau(k) + j, limit);
    }
  }
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    for (int row = 0; row < functions(k).num_rows(mesh_node(k).node); ++row) {
      if (const auto limit = functions(k).limit_of_row(robot, mesh_node(k).node, row)) {
        add(*limit, true, layout_.node_row(k) + row, k);
      }
    }
    const auto add_variable = [&](MotionLimit limit, int variable) {
      const auto goal = of_goals.find(variable);
      add(goal == of_goals.end() ? std::move(limit) : goal->second, false, variable, k);
    };
    for (int i = 0; i < 6 && k > 0; ++i) {
      if (of_goals.contains(layout_.q(k) + i)) add(of_goals.at(layout_.q(k) + i), false, layout_.q(k) + i, k);
      if (of_goals.contains(layout_.v(k) + i)) add(of_goals.at(layout_.v(k) + i), false, layout_.v(k) + i, k);
    }
    for (int j = 0; j < nu; ++j) {
      if (k > 0) {  // the start is as it is
        add_variable(limit_of_joint(robot, LimitKind::joint_position, j), layout_.q(k) + 6 + j);
        add_variable(limit_of_joint(robot, LimitKind::joint_velocity, j), layout_.v(k) + 6 + j);
      }
      add_variable(limit_of_joint(robot, LimitKind::torque, j), layout_.tau(k) + j);
    }
  }
  for (std::size_t s = 0; s < schedule_.stances().size(); ++s) {
    const Stance& stance = schedule_.stances()[s];
    if (!stance.lands() || !stance.place) continue;
    const std::string& contact = robot.contacts()[stance.contact].name;
    for (int axis = 0; axis < 2; ++axis) {
      add({.kind = LimitKind::place, .subject = contact, .unit = "m", .size = robot.size()}, false,
          layout_.place(static_cast<int>(s)) + axis, mesh_.index({stance.first_phase, 0}));
    }
  }
  return result;
}

}  // namespace prowl
