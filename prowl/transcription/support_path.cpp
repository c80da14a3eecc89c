#include "prowl/transcription/support_path.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kInnerPart = 0.8;  // of a support polygon, shrunk about its centre: the rest is for what the guess misses

/// The point of the convex hull of `corners` that is nearest to p (Frank and Wolfe's method, exact enough for a guess).
Vector2d nearest_in_hull(const std::vector<Vector2d>& corners, const Vector2d& p) {
  constexpr int kSteps = 100;
  Vector2d x = corners.front();
  for (int i = 0; i < kSteps; ++i) {
    const Vector2d away = x - p;
    const auto best = std::ranges::min_element(corners, {}, [&](const Vector2d& c) { return away.dot(c); });
    const Vector2d step = *best - x;
    if (-away.dot(step) <= 1e-12) break;  // no corner is nearer
    x += std::clamp(-away.dot(step) / step.squaredNorm(), 0.0, 1.0) * step;
  }
  return x;
}

/// Centre of mass of a configuration, horizontally from its base, world axes [m]: from the moment of the weight.
Vector2d centre_of_mass(const RobotModel& robot, const VectorXd& q) {
  RigidBodyTerms terms(robot);
  const VectorXd rest = VectorXd::Zero(robot.nv());
  terms.update(q, rest, rest);
  const Vector3d moment = base_rotation(q) * terms.inverse_dynamics().segment<3>(3);
  return Vector2d(-moment.y(), moment.x()) / robot.weight();
}

bool binds_base(const BoundaryCondition& condition) {
  return (condition.configuration_upper - condition.configuration_lower).head<2>().maxCoeff() < 1e-3;
}

}  // namespace

SupportPath::SupportPath(const MotionProblem& problem, const Mesh& mesh, const PosturePath& posture,
                         const ContactPath& contacts) {
  struct Pull {
    double time;
    Vector2d shift;
  };
  std::vector<Pull> pulls;
  for (const BoundaryCondition& condition : problem.boundary_conditions) {
    if (binds_base(condition)) pulls.push_back({time_of(condition, mesh), Vector2d::Zero()});
  }
  const double topple = std::sqrt(problem.robot.nominal_configuration()(2) / RobotModel::kGravity);
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
    const Phase& phase = problem.phases[static_cast<std::size_t>(p)];
    if (phase.contacts.empty()) continue;
    const double start = mesh.nodes[static_cast<std::size_t>(mesh.index({p, 0}))].time;
    const double end = mesh.nodes[static_cast<std::size_t>(mesh.index({p, phase.intervals}))].time;
    const VectorXd q = posture(0.5 * (start + end));
    const Vector2d com = q.head<2>() + centre_of_mass(problem.robot, q);

    std::vector<Vector2d> corners;
    Vector2d centre = Vector2d::Zero();
    for (const Vector3d& place : contacts.held_places(p)) {
      corners.push_back(place.head<2>());
      centre += place.head<2>() / static_cast<double>(phase.contacts.size());
    }
    for (Vector2d& corner : corners) corner = centre + kInnerPart * (corner - centre);
    const Vector2d shift = nearest_in_hull(corners, com) - com;
    if (shift.norm() < 1e-6) continue;
    const double part = std::min(1.0, std::pow((end - start) / topple, 2));
    pulls.push_back({start, part * shift});
    pulls.push_back({end, part * shift});
  }
  std::ranges::stable_sort(pulls, {}, &Pull::time);
  for (const int axis : {0, 1}) {
    std::vector<Waypoint> waypoints;
    for (const Pull& pull : pulls) {
      if (!waypoints.empty() && pull.time <= waypoints.back().time) {  // one time: between what both sides ask
        waypoints.back().value = 0.5 * (waypoints.back().value + pull.shift(axis));
      } else {
        waypoints.push_back({pull.time, pull.shift(axis), 0.0});
      }
    }
    curves_.emplace_back(waypoints);
  }
}

Vector2d SupportPath::operator()(double time) const { return {curves_[0](time), curves_[1](time)}; }

}  // namespace prowl
