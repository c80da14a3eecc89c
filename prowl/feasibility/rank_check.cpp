#include "prowl/feasibility/rank_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/projector.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/linear_algebra/factorisations.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

/// Joint displacement to nearby postures [rad, m]: far above the rank threshold of 1e-8, within most joint ranges.
constexpr double kBeside = 0.05;
constexpr int kPostures = 3;
constexpr double kPushes = 0.1;  // relative to the largest force of a push

Eigen::MatrixXd jacobian(const RobotModel& robot, const VectorXd& q, const std::vector<int>& contacts) {
  RigidBodyTerms terms(robot);
  terms.update_kinematics(q);
  ContactKinematics kinematics(contacts);
  kinematics.set_configuration(terms);
  return kinematics.jacobian();
}

int rank_of(const Eigen::MatrixXd& J) {
  Projector projector;
  projector.compute(J);
  return projector.rank();
}

/// Moves each joint by up to kBeside, no two alike, towards the middle of its range.
VectorXd posture_beside(const RobotModel& robot, const VectorXd& q, int which) {
  VectorXd beside = q;
  for (int j = 0; j < robot.nu(); ++j) {
    const double part = 0.6 + 0.4 * std::sin(1.0 + 2.4 * j + 1.7 * which);  // from 0.2 to 1
    const bool up = 2.0 * q(7 + j) < robot.position_lower()(j) + robot.position_upper()(j);
    beside(7 + j) += (up ? kBeside : -kBeside) * part;
  }
  return beside;
}

}  // namespace

std::optional<LostRank> lost_rank(const RobotModel& robot, const VectorXd& q, const std::vector<int>& contacts) {
  if (contacts.empty()) return std::nullopt;
  const Eigen::MatrixXd J = jacobian(robot, q, contacts);
  LostRank lost{.rank = rank_of(J), .beside = 0, .contacts = {}};
  if (lost.rank == J.rows()) return std::nullopt;
  for (int i = 0; i < kPostures; ++i) {
    lost.beside = std::max(lost.beside, rank_of(jacobian(robot, posture_beside(robot, q, i), contacts)));
  }
  if (lost.beside <= lost.rank) return std::nullopt;
  // Forces without torques and without a wrench on the base: J'f = 0. Flat feet add theirs.
  const VectorXd force = symmetric_eigen(J * J.transpose()).vectors.leftCols(J.rows() - lost.rank).rowwise().norm();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (force.segment<3>(3 * static_cast<Eigen::Index>(i)).norm() > kPushes * force.maxCoeff())
      lost.contacts.push_back(contacts[i]);
  }
  return lost;
}

std::vector<std::string> postures_that_lose_rank(const MotionProblem& problem, const Trajectory& guess) {
  std::vector<std::string> lines;
  int p = -1;
  for (const TrajectoryPoint& point : guess.nodes) {
    if (point.phase == p) continue;
    p = point.phase;
    const Phase& phase = problem.phases[p];
    const auto lost = lost_rank(problem.robot, point.q, contact_indices(phase.contacts));
    if (!lost) continue;
    std::vector<std::string> names;
    for (const int c : lost->contacts) names.push_back(problem.robot.contacts()[c].name);
    lines.push_back(fmt::format(
        "start of phase '{}': singular posture: the contact Jacobian has rank {} instead of {}; {} can "
        "push against each other without any torque, as with stretched legs: start with joints bent by a few degrees",
        phase.name, lost->rank, lost->beside, fmt::join(names, ", ")));
  }
  return lines;
}

}  // namespace prowl
