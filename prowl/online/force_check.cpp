#include "prowl/online/force_check.hpp"

#include <algorithm>

#include "prowl/mpc/standing_robot.hpp"

namespace prowl {

ForceCheck::ForceCheck(const RobotModel& robot, const std::vector<std::vector<int>>& feet, double friction)
    : robot_(robot), feet_(feet), friction_(friction), q_(robot.nominal_configuration()) {}

double ForceCheck::outside(const MpcPlan& plan, double t) {
  const MpcPlan::Step& step = plan.step_at(t);
  const std::vector<int> contacts = standing_contacts(feet_, step.standing);
  if (contacts.empty()) return 0.0;
  ConstrainedDynamicsOracle& oracle = oracles_.try_emplace(step.standing, robot_, contacts).first->second;
  plan.state(t, q_, v_);
  const Eigen::VectorXd force = oracle.evaluate(q_, v_, step.tau).force;
  double worst = 0.0;
  for (const int contact : contacts) {
    const Eigen::Vector3d f = force.segment<3>(3 * contact);
    worst = std::max({worst, f.head<2>().norm() - friction_ * f.z(), -f.z()});
  }
  return worst / robot_.weight();
}

}  // namespace prowl
