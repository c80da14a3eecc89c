#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "prowl/certificate/constrained_dynamics_oracle.hpp"
#include "prowl/mpc/mpc_plan.hpp"

namespace prowl {

/// Contact forces of a plan, computed anew by the oracle of the certificate from its states and torques.
class ForceCheck {
 public:
  /// `feet`: contacts of each foot; `friction`: of the cones.
  ForceCheck(const RobotModel& robot, const std::vector<std::vector<int>>& feet, double friction);

  /// The largest distance of a contact's force from its friction cone at time t [s] of a plan, as a share of the
  /// robot's weight: |tangential| - friction * normal, or the pull of a force that pulls. Level ground.
  double outside(const MpcPlan& plan, double t);

 private:
  const RobotModel& robot_;
  std::vector<std::vector<int>> feet_;
  double friction_;
  std::map<unsigned, ConstrainedDynamicsOracle> oracles_;  ///< by the bits of standing feet
  Eigen::VectorXd q_, v_;
};

}  // namespace prowl
