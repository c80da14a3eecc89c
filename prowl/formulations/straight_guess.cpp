#include "prowl/formulations/straight_guess.hpp"

#include <algorithm>
#include <iterator>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/transcription/contact_path.hpp"
#include "prowl/transcription/posture_path.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

struct Posture {
  double time;
  VectorXd q;
};

/// Of the start and of each goal, in the order of time.
std::vector<Posture> postures(const MotionProblem& problem, const Mesh& mesh) {
  const PosturePath path(problem, mesh);
  const ContactPath contacts(problem, mesh, path);
  std::vector<const BoundaryCondition*> conditions;
  for (const BoundaryCondition& condition : problem.boundary_conditions) conditions.push_back(&condition);
  std::ranges::stable_sort(conditions, {}, [&](const BoundaryCondition* c) { return mesh.index(c->at); });

  std::vector<Posture> found;
  VectorXd q = problem.start_configuration();
  for (const BoundaryCondition* condition : conditions) {
    q = inverse_kinematics(problem.robot, meet(*condition, q), contacts.targets(mesh.index(condition->at))).q;
    q = meet(*condition, q);
    const double time = time_of(*condition, mesh);
    if (!found.empty() && found.back().time == time) found.pop_back();  // both sides of a phase switch
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

Trajectory straight_guess(const MotionProblem& problem, const Mesh& mesh) {
  const std::vector<Posture> through = postures(problem, mesh);
  std::vector<StaticEquilibrium> standing;
  for (const Phase& phase : problem.phases) {
    standing.push_back(
        static_equilibrium(problem.robot, problem.start_configuration(), contact_indices(phase.contacts)));
  }

  Trajectory guess;
  for (const MeshNode& node : mesh.nodes) {
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
