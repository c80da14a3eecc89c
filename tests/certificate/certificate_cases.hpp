#pragma once

#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "prowl/certificate/certificate.hpp"
#include "tests/certificate/stance_motion.hpp"

namespace prowl::test {

using Names = std::set<std::string>;

inline Names failed_checks(const Certificate& certificate) {
  Names names;
  for (const CertificateCheck& check : certificate.checks) {
    if (!check.passed) names.insert(check.name);
  }
  return names;
}

inline const CertificateCheck& find(const Certificate& certificate, const std::string& name) {
  if (const CertificateCheck* const check = certificate.find(name)) return *check;
  throw std::out_of_range(name);
}

/// A problem and a motion that solves it. Faults of the problem are put into it once it is prepared: before, it would
/// be refused for some of them.
struct Case {
  DiscreteProblem discrete;
  Trajectory trajectory;
};

/// The problem that `trajectory` (one phase, all contacts) solves, on the mesh that it has.
inline Case stance_case(const RobotModel& robot, Trajectory trajectory) {
  const PhaseMesh mesh(static_cast<int>(trajectory.nodes.size()) - 1);
  return {{problem_of(robot, trajectory), {{mesh}}}, std::move(trajectory)};
}

/// All feet on the ground, nothing moves.
inline Case standing(const RobotModel& robot, int intervals = 10, double duration = 1.0) {
  StanceMotion motion(robot, duration, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  return stance_case(robot, motion.on_mesh(intervals));
}

/// A crouch and back in two seconds that also leans and turns.
inline Case crouching(const RobotModel& robot, int intervals) {
  StanceMotion motion(robot, 2.0, {0.03, 0.02, -0.05}, {0.03, 0.05, 0.04});
  return stance_case(robot, motion.by_trapezoid(intervals));
}

}  // namespace prowl::test
