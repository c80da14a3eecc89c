#include "prowl/mpc/latest_plans.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace prowl {
namespace {

constexpr double kAlways = -std::numeric_limits<double>::infinity();

}  // namespace

LatestPlans::LatestPlans(const RobotModel& robot, const MpcPlan& latest)
    : robot_(robot), latest_(latest), before_(latest), ready_(kAlways) {}

MpcPlan& LatestPlans::begin_next() {
  std::swap(latest_.steps(), before_.steps());
  ready_ = kAlways;
  return latest_;
}

void LatestPlans::drop_latest() {
  std::swap(latest_.steps(), before_.steps());
  ready_ = kAlways;
}

bool LatestPlans::torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau) const {
  const bool latest_acts = t >= std::max(latest_.start(), ready_) || before_.start() > t;
  const MpcPlan& plan = latest_acts ? latest_ : before_;
  if (t <= plan.end()) {
    plan.torque(t, q, v, tau);
    return true;
  }
  damping_torques(robot_, q, v, tau);
  return false;
}

}  // namespace prowl
