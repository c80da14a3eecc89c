#include "prowl/transcription/phase_setup.hpp"

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/transcription/node/independent_contacts.hpp"

namespace prowl {

std::vector<PhaseContacts> contacts_of_phases(const DiscreteProblem& discrete, const Trajectory& guess) {
  std::vector<PhaseContacts> contacts;
  for (int p = 0; p < static_cast<int>(discrete.problem.phases.size()); ++p) {
    const Eigen::VectorXd& q = guess.nodes[discrete.mesh.first_node(p)].q;
    contacts.push_back(phase_contacts(discrete, p, q));
  }
  return contacts;
}

std::vector<Eigen::VectorXd> anchor_origins(const DiscreteProblem& discrete) {
  const MotionProblem& problem = discrete.problem;
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(problem.start_configuration());
  std::vector<Eigen::VectorXd> origins;
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const auto& contacts = problem.phases[p].contacts;
    Eigen::VectorXd& anchors = origins.emplace_back(3 * static_cast<Eigen::Index>(contacts.size()));
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const ContactStance& stance =
          discrete.schedule.stances()[discrete.schedule.stance(static_cast<int>(p), static_cast<int>(i))];
      const double radius = problem.robot.contacts()[stance.contact].radius;
      anchors.segment<3>(static_cast<Eigen::Index>(3 * i)) =
          stance.lands() ? problem.surfaces[stance.surface].at({0.0, 0.0}, radius)
                         : terms.contact_position(stance.contact);
    }
  }
  return origins;
}

}  // namespace prowl
