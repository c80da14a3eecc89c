#pragma once

#include <Eigen/Core>
#include <random>

#include "prowl/dynamics/projected_residual.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/robot_model.hpp"
#include "tests/support/random_vector.hpp"

/// Random places at which derivatives are tested: the base turned any way, joints within half a radian of the nominal
/// posture (so that no leg is straight), motions and torques of the size that the robot knows.
namespace prowl::test {

inline DynamicsPoint random_point(const RobotModel& robot, const std::vector<int>& contacts, std::mt19937& rng,
                                  std::size_t num_chosen_rows = 0) {
  DynamicsPoint point;
  Eigen::VectorXd tangent = random_vector(rng, robot.nv(), 0.5);
  // Chosen rows are chosen for a posture, and go with the like of it.
  if (num_chosen_rows == 0) tangent.segment<3>(3) *= 4.0;
  point.q = integrate(robot.nominal_configuration(), tangent);
  point.v = random_vector(rng, robot.nv(), 2.0);
  point.a = random_vector(rng, robot.nv(), 10.0);
  point.tau = random_vector(rng, robot.nu(), 0.2 * robot.weight());
  point.anchors = random_vector(rng, 3 * static_cast<Eigen::Index>(contacts.size()), 0.5);
  point.stabilisation = {20.0, 100.0};
  point.chosen_forces = random_vector(rng, static_cast<Eigen::Index>(num_chosen_rows), 0.2 * robot.weight());
  return point;
}

/// Moves one argument of a point: q along its tangent, the others as vectors.
enum class Argument { q, v, a, tau, w, anchor };
inline Eigen::VectorXd& vector_of(DynamicsPoint& point, Argument argument) {
  switch (argument) {
    case Argument::v: return point.v;
    case Argument::a: return point.a;
    case Argument::tau: return point.tau;
    case Argument::w: return point.chosen_forces;
    case Argument::anchor: return point.anchors;
    default: return point.q;
  }
}
inline Eigen::Index size_of(const DynamicsPoint& point, Argument argument) {
  DynamicsPoint copy = point;
  return argument == Argument::q ? point.v.size() : vector_of(copy, argument).size();
}
inline DynamicsPoint moved(const DynamicsPoint& point, Argument argument, Eigen::Index index, double by) {
  DynamicsPoint result = point;
  if (argument == Argument::q) {
    Eigen::VectorXd tangent = Eigen::VectorXd::Zero(point.v.size());
    tangent(index) = by;
    result.q = integrate(point.q, tangent);
  } else {
    vector_of(result, argument)(index) += by;
  }
  return result;
}

}  // namespace prowl::test
