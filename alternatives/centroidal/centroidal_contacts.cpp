#include "alternatives/centroidal/centroidal_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prowl/transcription/node/independent_contacts.hpp"

namespace prowl {

namespace {

using Eigen::Index;

}  // namespace

CentroidalContacts centroidal_contacts(const DiscreteProblem& discrete, int phase, const Eigen::VectorXd& q,
                                       const std::vector<LandingAxes>& landing) {
  const MotionProblem& problem = discrete.problem;
  const ContactSchedule& schedule = discrete.schedule;
  constexpr int kNormal = 2;
  const auto& held = problem.phases[phase].contacts;
  const int num_contacts = static_cast<int>(held.size());
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(q);
  ContactKinematics kinematics(contact_indices(held));
  kinematics.set_configuration(terms);
  const std::vector<int> independent =
      independent_rows(Eigen::MatrixXd(0, problem.robot.nv()), along_surfaces(problem, held, kinematics.jacobian()));

  CentroidalContacts result;
  terms.update_kinematics(problem.start_configuration());
  for (int i = 0; i < num_contacts; ++i) {
    const PhaseContact& contact = held[i];
    const Surface& surface = problem.surfaces[contact.surface];
    const ContactPoint& point = problem.robot.contacts()[contact.contact];
    const Eigen::Matrix3d axes = surface.frame();
    const double on_surface = surface.normal.dot(surface.point) + point.radius;
    const bool landed = schedule.stances()[schedule.stance(phase, i)].lands();
    for (int axis = 0; axis < 3; ++axis) {
      if (std::ranges::find(independent, 3 * i + axis) == independent.end()) continue;
      if (axis == kNormal) {
        const double height = landed ? on_surface : surface.normal.dot(terms.contact_position(contact.contact));
        result.distance.push_back({i, axes.col(axis), height, point.name + ", distance to " + surface.name});
      } else {
        result.sliding.push_back({i, axes.col(axis), 0.0,
                                  fmt::format("{}, sliding along axis {} of {}", point.name, axis + 1, surface.name)});
      }
    }
    const bool is_chosen = !landed && !landing[i].foothold.empty();  // at a free start
    for (int axis = 0; is_chosen && axis < kNormal; ++axis) {
      result.landing.push_back({i, axes.col(axis), axes.col(axis).dot(terms.contact_position(contact.contact)),
                                fmt::format("{}, start along axis {} of {}", point.name, axis + 1, surface.name)});
    }
    if (!schedule.lands(phase, i)) continue;
    for (const int axis : landing[i].foothold) {
      if (axis != kNormal && !contact.foothold) continue;
      const double position = axis == kNormal ? on_surface : axes.col(axis).dot(*contact.foothold);
      result.landing.push_back({i, axes.col(axis), position,
                                fmt::format("{}, landing along axis {} of {}", point.name, axis + 1, surface.name)});
    }
  }
  return result;
}

}  // namespace prowl
