#include "prowl/online/force_check.hpp"

#include <algorithm>

namespace prowl {

ForceCheck::ForceCheck(const RobotModel& robot, const std::vector<std::vector<int>>& feet, double friction)
    : robot_(robot), feet_(feet), friction_(friction), q_(robot.nominal_configuration()) {}

double ForceCheck::outside(const MpcPlan& plan, double t) {
  const MpcPlan::Step& step = plan.step_at(t);
  std::vector<int> contacts;
  for (std::size_t f = 0; f < feet_.size(); ++f) {
    if (((step.standing >> f) & 1U) != 0) contacts.insert(contacts.end(), feet_[f].begin(), feet_[f].end());
  }
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
