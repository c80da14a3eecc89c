#include "prowl/mpc/standing_robot.hpp"

#include <algorithm>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/error.hpp"

namespace prowl {

Eigen::VectorXd standing_on_ground(const RobotModel& robot) {
  Eigen::VectorXd q = robot.nominal_configuration();
  RigidBodyTerms terms(robot);
  terms.update_kinematics(q);
  std::vector<ContactTarget> targets;
  for (int c = 0; c < static_cast<int>(robot.contacts().size()); ++c) {
    Eigen::Vector3d position = terms.contact_position(c);
    position.z() = robot.contacts()[static_cast<std::size_t>(c)].radius;
    targets.push_back({c, position});
  }
  const InverseKinematics standing = inverse_kinematics(robot, q, targets);
  constexpr double kOff = 1e-3;  // [m], as of the start of a planned motion
  if (!(standing.residual <= kOff))
    throw InputError(robot.name() + ": the nominal posture does not stand: its contacts do not reach the ground");
  return standing.q;
}

std::vector<std::vector<int>> contacts_of_feet(const RobotModel& robot) {
  RigidBodyTerms terms(robot);
  terms.update_kinematics(robot.nominal_configuration());
  std::vector<std::vector<int>> feet;
  std::vector<int> bodies;
  for (int c = 0; c < static_cast<int>(robot.contacts().size()); ++c) {
    const int body = terms.contact_point(c).body;
    const auto known = std::find(bodies.begin(), bodies.end(), body);
    if (known == bodies.end()) {
      bodies.push_back(body);
      feet.push_back({c});
    } else {
      feet[static_cast<std::size_t>(known - bodies.begin())].push_back(c);
    }
  }
  return feet;
}

std::vector<int> standing_contacts(const std::vector<std::vector<int>>& feet, unsigned standing) {
  std::vector<int> contacts;
  for (std::size_t f = 0; f < feet.size(); ++f) {
    if ((standing >> f & 1U) != 0) contacts.insert(contacts.end(), feet[f].begin(), feet[f].end());
  }
  std::ranges::sort(contacts);
  return contacts;
}

MpcPlan::Step standing_step(const RobotModel& robot, const std::vector<std::vector<int>>& feet,
                            const Eigen::VectorXd& q) {
  const unsigned all = (1U << feet.size()) - 1U;
  const StaticEquilibrium still = static_equilibrium(robot, q, standing_contacts(feet, all));
  MpcPlan::Step step;
  step.standing = all;
  step.q = q;
  step.v = step.a = Eigen::VectorXd::Zero(robot.nv());
  step.tau = still.tau;
  step.force = still.force;
  step.gain = Eigen::MatrixXd::Zero(robot.nu(), 2 * robot.nv());
  return step;
}

}  // namespace prowl
