#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/mpc/contact_timeline.hpp"
#include "prowl/mpc/latest_plans.hpp"

namespace prowl {

/// Where a robot will be when a plan made now acts: its rigid-body dynamics under the torques of the plans so
/// far. No function allocates but the constructor.
class StatePrediction {
 public:
  /// `feet`: contacts of each foot, see contacts_of_feet().
  StatePrediction(const RobotModel& robot, const std::vector<std::vector<int>>& feet);

  /// Moves the state (q, v) at time `from` on to time `to` [s].
  void predict(const LatestPlans& plans, const ContactTimeline& timeline, double from, double to, Eigen::VectorXd& q,
               Eigen::VectorXd& v);

 private:
  const RobotModel& robot_;
  std::vector<std::unique_ptr<ForwardDynamics>> dynamics_;  ///< by the bits of standing feet
  Eigen::VectorXd a_, tau_, v_middle_;
};

}  // namespace prowl
