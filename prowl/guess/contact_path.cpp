#include "prowl/guess/contact_path.hpp"

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/all_contacts.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/surface.hpp"

namespace prowl {

using Eigen::Vector3d;
using Eigen::VectorXd;

ContactPath::ContactPath(const DiscreteProblem& discrete, const PosturePath& posture) : discrete_(discrete) {
  const MotionProblem& problem = discrete.problem;
  RigidBodyTerms terms(problem.robot);
  const VectorXd& start = problem.start_configuration();
  terms.update_kinematics(start);
  std::vector<Vector3d> start_positions;
  for (const int contact : all_contacts(problem.robot)) start_positions.push_back(terms.contact_position(contact));
  for (const ContactStance& stance : discrete_.schedule.stances()) {
    const Vector3d& at_start = start_positions[stance.contact];
    if (!stance.lands()) {
      footholds_.push_back(at_start);
      continue;
    }
    const Surface& surface = problem.surfaces[stance.surface];
    const double radius = problem.robot.contacts()[stance.contact].radius;
    const Span held = span(stance.first_phase, stance.last_phase);
    const VectorXd q = posture(0.5 * (held.start + held.end));
    Vector3d carried =
        base_position(q) + base_rotation(q) * (base_rotation(start).transpose() * (at_start - base_position(start)));
    if (problem.reference) {
      terms.update_kinematics(q);
      carried = terms.contact_position(stance.contact);
    }
    footholds_.push_back(
        surface.at(nearest_in_patch(surface, surface.coordinates(stance.foothold.value_or(carried))), radius));
  }
}

ContactPath::Span ContactPath::span(int first_phase, int last_phase) const {
  return {discrete_.nodes[discrete_.mesh.first_node(first_phase)].time,
          discrete_.nodes[discrete_.mesh.last_node(last_phase)].time};
}

std::vector<Vector3d> ContactPath::held_footholds(int phase) const {
  std::vector<Vector3d> footholds;
  const std::size_t count = discrete_.problem.phases[phase].contacts.size();
  for (int i = 0; i < static_cast<int>(count); ++i) {
    footholds.push_back(footholds_[discrete_.schedule.stance(phase, i)]);
  }
  return footholds;
}

std::vector<ContactTarget> ContactPath::targets(int k) const {
  const MeshNode& node = discrete_.nodes[k];
  const auto now = [&](const auto& time) { return time.first_phase <= node.phase && node.phase <= time.last_phase; };
  std::vector<ContactTarget> targets;
  for (std::size_t s = 0; s < discrete_.schedule.stances().size(); ++s) {
    if (now(discrete_.schedule.stances()[s]))
      targets.push_back({discrete_.schedule.stances()[s].contact, footholds_[s]});
  }
  for (const ContactSwing& swing : discrete_.schedule.swings()) {
    if (!now(swing) || swing.before < 0 || swing.after < 0) continue;
    const Span time = span(swing.first_phase, swing.last_phase);
    const double s = (node.time - time.start) / (time.end - time.start);
    const Vector3d& from = footholds_[swing.before];
    const Vector3d& to = footholds_[swing.after];
    const int surface = discrete_.schedule.stances()[swing.after].surface;
    const Vector3d lift = discrete_.problem.swing_clearance * discrete_.problem.surfaces[surface].normal;
    // At rest at both ends; an arc of four thirds of the clearance keeps the guess off the bound.
    const double along = s * s * (3.0 - 2.0 * s), arc = 16.0 * s * s * (1.0 - s) * (1.0 - s);
    targets.push_back({swing.contact, from + along * (to - from) + arc * 4.0 / 3.0 * lift});
  }
  return targets;
}

}  // namespace prowl
