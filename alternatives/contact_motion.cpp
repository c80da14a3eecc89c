#include "alternatives/contact_motion.hpp"

#include <algorithm>

#include "prowl/dynamics/contact_kinematics.hpp"

namespace prowl {

ContactMotion contact_motion(const MotionProblem& problem, const Trajectory& motion) {
  RigidBodyTerms terms(problem.robot);
  std::vector<ContactKinematics> held;  // per phase
  for (const Phase& phase : problem.phases) held.emplace_back(contact_indices(phase.contacts));
  ContactMotion worst;
  for (const TrajectoryPoint& node : motion.nodes) {
    ContactKinematics& contacts = held[node.phase];
    terms.update_kinematics(node.q);
    contacts.set_configuration(terms);
    contacts.set_motion(node.v, node.a);
    const Eigen::VectorXd velocity = contacts.jacobian() * node.v;
    for (Eigen::Index row = 0; row < velocity.size(); row += 3) {
      worst.velocity = std::max(worst.velocity, velocity.segment<3>(row).norm());
      worst.acceleration = std::max(worst.acceleration, contacts.acceleration().segment<3>(row).norm());
    }
  }
  return worst;
}

}  // namespace prowl
