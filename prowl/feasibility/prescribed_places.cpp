#include "prowl/feasibility/prescribed_places.hpp"

#include <algorithm>
#include <limits>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {

using Eigen::Vector3d;

std::vector<std::optional<Vector3d>> prescribed_places(const MotionProblem& problem, const ContactSchedule& schedule) {
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(problem.start_configuration());
  std::vector<std::optional<Vector3d>> places;
  for (const Stance& stance : schedule.stances()) {
    std::optional<Vector3d>& place = places.emplace_back();
    if (!stance.lands()) {
      place = terms.contact_position(stance.contact);
    } else if (stance.place) {
      const Surface& surface = problem.surfaces[stance.surface];
      const double radius = problem.robot.contacts()[stance.contact].radius;
      place = surface.at(surface.coordinates(*stance.place), radius);
    }
  }
  return places;
}

bool is_during(const BoundaryCondition& condition, int phase) {
  return condition.at.phase == phase || condition.at == PhaseFraction::end_of(phase - 1) ||
         condition.at == PhaseFraction::start_of(phase + 1);
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

PointBounds point_bounds(const BoundaryCondition& condition, const Vector3d& offset) {
  const Vector3d base = base_position(condition.q_ref);
  PointBounds bounds{base + condition.configuration_lower.head<3>(), base + condition.configuration_upper.head<3>()};
  const bool turns = !condition.configuration_lower.segment<3>(3).isZero(0.0) ||
                     !condition.configuration_upper.segment<3>(3).isZero(0.0);
  if (turns) {
    bounds.slack = offset.norm();
  } else {
    const Vector3d turned = base_rotation(condition.q_ref) * offset;
    bounds.lower += turned;
    bounds.upper += turned;
  }
  return bounds;
}

}  // namespace prowl
