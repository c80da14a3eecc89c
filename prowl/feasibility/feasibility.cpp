#include "prowl/feasibility/feasibility.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/feasibility/prescribed_footholds.hpp"
#include "prowl/feasibility/rank_check.hpp"
#include "prowl/feasibility/reach_check.hpp"
#include "prowl/feasibility/slide_check.hpp"
#include "prowl/feasibility/standing_load.hpp"
#include "prowl/feasibility/term_reach_check.hpp"
#include "prowl/model/surface.hpp"

namespace prowl {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kAtItsFoothold = 1e-3;  // [m]
constexpr double kFull = 0.999;          // of the weight or of a torque limit; more counts as all of it

/// Contacts that a posture does not put on their footholds; several share one line, with the numbers of the worst.
std::vector<std::string> missed_footholds(const MotionProblem& problem, const ContactSchedule& schedule, int p,
                                          const VectorXd& q, const std::string& when) {
  const auto footholds = prescribed_footholds(problem, schedule);
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(q);
  std::vector<std::string> missed;
  std::string worst;
  double largest = 0.0;
  const auto& held = problem.phases[p].contacts;
  for (int i = 0; i < static_cast<int>(held.size()); ++i) {
    const PhaseContact& phase_contact = held[i];
    const ContactPoint& contact = problem.robot.contacts()[phase_contact.contact];
    const Surface& surface = problem.surfaces[phase_contact.surface];
    const Vector3d is = terms.contact_position(phase_contact.contact);
    const Vector3d should = footholds[schedule.stance(p, i)].value_or(
        surface.at(nearest_in_patch(surface, surface.coordinates(is)), contact.radius));
    const double gap = (is - should).norm();
    if (gap <= kAtItsFoothold) continue;
    missed.push_back(contact.name);
    if (gap > largest) worst = contact.name;
    largest = std::max(largest, gap);
  }
  if (missed.empty()) return {};
  return {missed.size() == 1
              ? fmt::format("{}: no posture found with contact {} on its foothold: {:.3g} m off", when, worst, largest)
              : fmt::format("{}: no posture found with the {} contacts {} on their footholds: {} is {:.3g} m off", when,
                            missed.size(), fmt::join(missed, ", "), worst, largest)};
}

/// "goal 1, end of phase 'stand'"; "" for nodes that are not checked.
std::string name_of_node(const DiscreteProblem& discrete, int k) {
  const Phase& phase = discrete.phase_of(k);
  const MeshNode& node = discrete.nodes[k];
  std::string goals;
  for (std::size_t c = 1; c < discrete.boundary_nodes.size(); ++c) {
    if (discrete.boundary_nodes[c] == k) goals += discrete.problem.boundary_constraints[c].name + ", ";
  }
  if (node.h_in == 0.0) return fmt::format("{}start of phase '{}'", goals, phase.name);
  if (node.h_out == 0.0) return fmt::format("{}end of phase '{}'", goals, phase.name);
  return goals.empty() ? "" : fmt::format("{}phase '{}'", goals, phase.name);
}

constexpr std::size_t kStands = 3;  // contacts; with fewer, as in a trot, a robot need not stand still

/// "" if the robot can stand still in this posture, need not, or the solver fails.
std::string why_it_cannot_stand(const MotionProblem& problem, const Phase& phase, const VectorXd& q,
                                const NlpSolver& solver) {
  if (phase.contacts.size() < kStands) return "";
  const StandingLoad load = standing_load(problem, q, phase.contacts, solver);
  if (!load.solved || load.share >= kFull) return "";
  if (load.share < 1.0 - kFull) {
    return "cannot stand still in the guessed posture: its contacts cannot balance the weight (foot positions, "
           "friction)";
  }
  const RobotModel& robot = problem.robot;
  std::vector<std::string> joints;
  for (int j = 0; j < robot.nu(); ++j) {
    const double needed = load.torque_needed(j);
    const double limit = needed < 0.0 ? robot.torque_lower(j, q(7 + j), 0.0) : robot.torque_upper(j, q(7 + j), 0.0);
    if (std::abs(load.share * needed) < kFull * std::abs(limit)) continue;
    joints.push_back(fmt::format("{} needs {:.3g} {} (limit {:.3g})", robot.joint_names()[j], std::abs(needed),
                                 robot.joint_is_prismatic()[j] ? "N" : "N m", std::abs(limit)));
  }
  return fmt::format("cannot stand still in the guessed posture: {}", fmt::join(joints, ", "));
}

}  // namespace

std::vector<std::string> proofs_of_infeasibility(const MotionProblem& problem, const ContactSchedule& schedule) {
  std::vector<std::string> reasons = contacts_out_of_reach(problem, schedule);
  for (std::string& reason : terms_out_of_reach(problem, schedule)) reasons.push_back(std::move(reason));
  if (const auto reason = why_it_slides(problem, schedule)) reasons.push_back(*reason);
  return reasons;
}

std::vector<std::string> doubts(const DiscreteProblem& discrete, const Trajectory& guess, const NlpSolver& solver) {
  const MotionProblem& problem = discrete.problem;
  std::vector<std::string> lines = postures_that_lose_rank(problem, guess);
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    const std::string when = name_of_node(discrete, k);
    if (when.empty()) continue;
    const std::vector<std::string> missed =
        missed_footholds(problem, discrete.schedule, discrete.nodes[k].phase, guess.nodes[k].q, when);
    lines.insert(lines.end(), missed.begin(), missed.end());
    if (!missed.empty()) continue;  // standing still needs all footholds
    const std::string reason = why_it_cannot_stand(problem, discrete.phase_of(k), guess.nodes[k].q, solver);
    if (!reason.empty()) lines.push_back(when + ": " + reason);
  }
  return lines;
}

}  // namespace prowl
