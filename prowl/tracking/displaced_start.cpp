#include "prowl/tracking/displaced_start.hpp"

#include <fmt/format.h>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/tracking/linearised_dynamics.hpp"
#include "prowl/tracking/segment_contacts.hpp"

namespace prowl {

StartState displaced_start(const RobotModel& robot, const Tracker& tracker,
                           const Eigen::Matrix<double, 6, 1>& displacement) {
  if (!displacement.allFinite()) throw InputError("base offset: need finite numbers");
  const std::vector<int> contacts = contacts_of(tracker.plan().segments.front());
  StartState start{Eigen::VectorXd(robot.nq()), Eigen::VectorXd(robot.nv())};
  tracker.reference(tracker.start(), start.q, start.v);
  if (displacement.isZero(0.0)) return start;

  Eigen::VectorXd move = Eigen::VectorXd::Zero(robot.nv());
  move.head<6>() = displacement;
  const Eigen::VectorXd moved = integrate(start.q, move);
  if (contacts.empty()) return {moved, start.v};
  RigidBodyTerms terms(robot);
  terms.update_kinematics(start.q);
  std::vector<ContactTarget> feet;
  for (const int c : contacts) feet.push_back({c, terms.contact_position(c)});
  const InverseKinematics found = inverse_kinematics(robot, moved, feet);
  if (!found.converged) {
    throw InputError(fmt::format("base offset: {:.3g} m and {:.3g} rad are out of reach of the legs by {:.1f} mm",
                                 displacement.head<3>().norm(), displacement.tail<3>().norm(), 1e3 * found.residual));
  }
  return {found.q, velocity_after_landing(robot, contacts, found.q, start.v)};
}

}  // namespace prowl
