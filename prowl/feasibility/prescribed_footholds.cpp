#include "prowl/feasibility/prescribed_footholds.hpp"

#include <algorithm>
#include <limits>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {

using Eigen::Vector3d;

std::vector<std::optional<Vector3d>> prescribed_footholds(const MotionProblem& problem,
                                                          const ContactSchedule& schedule) {
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(problem.start_configuration());
  std::vector<std::optional<Vector3d>> footholds;
  for (const ContactStance& stance : schedule.stances()) {
    std::optional<Vector3d>& foothold = footholds.emplace_back();
    if (!stance.lands()) {
      foothold = terms.contact_position(stance.contact);
    } else if (stance.foothold) {
      const Surface& surface = problem.surfaces[stance.surface];
      const double radius = problem.robot.contacts()[stance.contact].radius;
      foothold = surface.at(surface.coordinates(*stance.foothold), radius);
    }
  }
  return footholds;
}

bool is_during(const BoundaryConstraint& constraint, int phase) {
  return constraint.at.phase == phase || constraint.at == PhaseFraction::end_of(phase - 1) ||
         constraint.at == PhaseFraction::start_of(phase + 1);
}

double PointBounds::distance(const Vector3d& p) const {
  const Vector3d outside = (lower - p).cwiseMax(p - upper).cwiseMax(0.0);
  return std::max(0.0, outside.norm() - slack);
}

double PointBounds::least_along(const Vector3d& d) const {
  double least = -slack;
  for (int i = 0; i < 3; ++i) {
    if (d(i) != 0.0) least += std::min(d(i) * lower(i), d(i) * upper(i));
  }
  return least;
}

PointBounds point_bounds(const BoundaryConstraint& constraint, const Vector3d& offset) {
  const Vector3d base = base_position(constraint.q_ref);
  PointBounds bounds{base + constraint.configuration_lower.head<3>(), base + constraint.configuration_upper.head<3>()};
  const bool turns = !constraint.configuration_lower.segment<3>(3).isZero(0.0) ||
                     !constraint.configuration_upper.segment<3>(3).isZero(0.0);
  if (turns) {
    bounds.slack = offset.norm();
  } else {
    const Vector3d turned = base_rotation(constraint.q_ref) * offset;
    bounds.lower += turned;
    bounds.upper += turned;
  }
  return bounds;
}

}  // namespace prowl
