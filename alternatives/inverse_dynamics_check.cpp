#include "alternatives/inverse_dynamics_check.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/model/all_contacts.hpp"
#include "prowl/model/torque_share.hpp"
#include "prowl/transcription/node/node_cost.hpp"

namespace prowl {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Forces of the contacts of the phase, in its order.
VectorXd held_forces(const Phase& phase, const VectorXd& forces) {
  VectorXd held(3 * static_cast<Index>(phase.contacts.size()));
  for (std::size_t i = 0; i < phase.contacts.size(); ++i) {
    held.segment<3>(static_cast<Index>(3 * i)) = forces.segment<3>(3 * phase.contacts[i].contact);
  }
  return held;
}

/// Trapezoidal quadrature weight of node k [s]. Both nodes of a phase transition have their own.
double time_of_node(const Trajectory& motion, std::size_t k) {
  const TrajectoryPoint& here = motion.nodes[k];
  const auto step = [&](std::size_t other) {
    return motion.nodes[other].phase == here.phase ? std::abs(motion.nodes[other].time - here.time) : 0.0;
  };
  return 0.5 * ((k > 0 ? step(k - 1) : 0.0) + (k + 1 < motion.nodes.size() ? step(k + 1) : 0.0));
}

double task_cost(const MotionProblem& problem, const Trajectory& motion) {
  NodeCost cost(problem);
  RigidBodyTerms terms(problem.robot);
  double total = 0.0;
  for (std::size_t k = 0; k < motion.nodes.size(); ++k) {
    const TrajectoryPoint& here = motion.nodes[k];
    NodePoint point;
    point.q = here.q;
    point.v = here.v;
    point.a = here.a;
    point.tau = here.tau;
    point.cost_weight = time_of_node(motion, k);
    point.terminal_weight = k + 1 == motion.nodes.size() ? 1.0 : 0.0;
    terms.update_kinematics(here.q);
    total += cost.value(point, terms, held_forces(problem.phases[here.phase], here.force));
  }
  return total;
}

}  // namespace

InverseDynamics::InverseDynamics(const RobotModel& robot) : terms_(robot), contacts_(all_contacts(robot)) {}

VectorXd InverseDynamics::operator()(const TrajectoryPoint& point) {
  terms_.update(point.q, point.v, point.a);
  contacts_.set_configuration(terms_);
  return terms_.inverse_dynamics() - contacts_.jacobian().transpose() * point.force;
}

InverseDynamicsCheck check_by_inverse_dynamics(const MotionProblem& problem, const Trajectory& motion) {
  const RobotModel& robot = problem.robot;
  InverseDynamics needed(robot);
  InverseDynamicsCheck check;
  Trajectory driven = motion;
  for (std::size_t k = 0; k < driven.nodes.size(); ++k) {
    TrajectoryPoint& point = driven.nodes[k];
    const VectorXd force = needed(point);
    point.tau = force.tail(robot.nu());
    for (int j = 0; j < robot.nu(); ++j) {
      const double share = torque_share(robot, j, point.q(7 + j), point.v(6 + j), point.tau(j));
      if (share <= check.worst_torque) continue;
      check.worst_torque = share;
      check.worst_joint = robot.joint_names()[j];
      check.worst_torque_time = point.time;
    }
    const double base_force = force.head<3>().norm() / robot.weight();
    const double base_moment = force.segment<3>(3).norm() / (robot.weight() * robot.size());
    if (std::max(base_force, base_moment) > std::max(check.worst_base_force, check.worst_base_moment)) {
      check.worst_base_time = point.time;
    }
    check.mean_base_force += base_force * time_of_node(motion, k) / motion.duration();
    check.worst_base_force = std::max(check.worst_base_force, base_force);
    check.worst_base_moment = std::max(check.worst_base_moment, base_moment);
  }
  check.cost = task_cost(problem, driven);
  return check;
}

}  // namespace prowl
