#include "alternatives/straight_guess.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/guess/contact_path.hpp"
#include "prowl/guess/posture_path.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

struct Posture {
  double time;
  VectorXd q;
};

/// Postures of start and goals, in order of time.
std::vector<Posture> postures(const DiscreteProblem& discrete) {
  const MotionProblem& problem = discrete.problem;
  const PosturePath path(discrete);
  const ContactPath contacts(discrete, path);
  std::vector<std::size_t> in_order(discrete.boundary_nodes.size());
  std::iota(in_order.begin(), in_order.end(), 0);
  std::ranges::stable_sort(in_order, {}, [&](std::size_t c) { return discrete.boundary_nodes[c]; });

  std::vector<Posture> found;
  VectorXd q = problem.start_configuration();
  for (const std::size_t c : in_order) {
    const BoundaryConstraint& constraint = problem.boundary_constraints[c];
    q = inverse_kinematics(problem.robot, meet(constraint, q), contacts.targets(discrete.boundary_nodes[c])).q;
    q = meet(constraint, q);
    const double time = discrete.boundary_time(c);
    if (!found.empty() && found.back().time == time) found.pop_back();  // phase transition
    found.push_back({time, q});
  }
  return found;
}

VectorXd on_straight_line(const std::vector<Posture>& postures, double time) {
  const auto next = std::ranges::upper_bound(postures, time, {}, &Posture::time);
  if (next == postures.end()) return postures.back().q;
  const Posture& last = *std::prev(next);  // the start is at time 0
  return integrate(last.q, (time - last.time) / (next->time - last.time) * difference(last.q, next->q));
}

}  // namespace

Trajectory straight_guess(const DiscreteProblem& discrete) {
  const MotionProblem& problem = discrete.problem;
  const std::vector<Posture> through = postures(discrete);
  std::vector<StaticEquilibrium> standing;
  for (const Phase& phase : problem.phases) {
    standing.push_back(
        static_equilibrium(problem.robot, problem.start_configuration(), contact_indices(phase.contacts)));
  }

  Trajectory guess;
  for (const MeshNode& node : discrete.nodes) {
    const StaticEquilibrium& hold = standing[node.phase];
    guess.nodes.push_back({.time = node.time,
                           .phase = node.phase,
                           .q = on_straight_line(through, node.time),
                           .v = VectorXd::Zero(problem.robot.nv()),
                           .a = VectorXd::Zero(problem.robot.nv()),
                           .tau = hold.tau,
                           .force = hold.force});
  }
  return guess;
}

}  // namespace prowl
