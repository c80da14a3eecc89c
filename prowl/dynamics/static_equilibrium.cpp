#include "prowl/dynamics/static_equilibrium.hpp"

#include <cmath>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/linear_algebra/factorisations.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {

namespace {

/// RMS distance of points (3 rows each) from the base [m]: turns moments about the base into forces.
double lever(const Eigen::VectorXd& positions, const Eigen::Vector3d& base) {
  const auto count = positions.size() / 3;
  return (positions - base.replicate(count, 1)).norm() / std::sqrt(static_cast<double>(count));
}

}  // namespace

StaticEquilibrium static_equilibrium(const RobotModel& robot, const Eigen::VectorXd& q,
                                     const std::vector<int>& contacts) {
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(robot.nv());
  return equilibrium_in_motion(robot, q, rest, rest, contacts);
}

StaticEquilibrium equilibrium_in_motion(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                        const Eigen::VectorXd& a, const std::vector<int>& contacts) {
  RigidBodyTerms terms(robot);
  terms.update(q, v, a);
  const Eigen::VectorXd& total = terms.inverse_dynamics();

  StaticEquilibrium result;
  result.tau = total.tail(robot.nu());
  result.force.setZero(3 * static_cast<Eigen::Index>(robot.contacts().size()));
  if (contacts.empty()) {
    result.residual = total.head<6>().norm();
    return result;
  }

  ContactKinematics kinematics(contacts);
  kinematics.set_configuration(terms);
  const Eigen::MatrixXd& J = kinematics.jacobian();
  Eigen::Vector<double, 6> scale = Eigen::Vector<double, 6>::Ones();
  scale.tail<3>() /= lever(kinematics.positions(), base_position(q));
  const Eigen::MatrixXd balance = scale.asDiagonal() * J.leftCols<6>().transpose();
  const Eigen::VectorXd load = scale.asDiagonal() * total.head<6>();

  // Rank-revealing: two point feet leave the moment about their line unbalanced (rank 5).
  const Eigen::VectorXd f = least_norm_solution(balance, load, 1e-9);

  result.residual = (balance * f - load).norm();
  result.tau -= J.rightCols(robot.nu()).transpose() * f;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    result.force.segment<3>(3 * contacts[i]) = f.segment<3>(3 * static_cast<Eigen::Index>(i));
  }
  return result;
}

}  // namespace prowl
