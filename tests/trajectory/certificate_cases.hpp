#pragma once

#include <set>
#include <stdexcept>
#include <string>

#include "prowl/certificate/certificate.hpp"
#include "tests/trajectory/stance_motion.hpp"

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

/// A problem and a motion that solves it.
struct Case {
  MotionProblem problem;
  Trajectory trajectory;
};

/// All feet on the ground, nothing moves.
inline Case standing(const RobotModel& robot, int intervals = 10, double duration = 1.0) {
  StanceMotion motion(robot, duration, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  Trajectory trajectory = motion.on_mesh(intervals);
  return {problem_of(robot, trajectory), std::move(trajectory)};
}

/// A crouch and back in two seconds that also leans and turns.
inline Case crouching(const RobotModel& robot, int intervals) {
  StanceMotion motion(robot, 2.0, {0.03, 0.02, -0.05}, {0.03, 0.05, 0.04});
  Trajectory trajectory = motion.by_trapezoid(intervals);
  return {problem_of(robot, trajectory), std::move(trajectory)};
}

}  // namespace prowl::test
