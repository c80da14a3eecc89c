#include "prowl/mpc/latest_plans.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace prowl {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity(), kAlways = -kNever;

}  // namespace

LatestPlans::LatestPlans(const RobotModel& robot, const MpcPlan& first)
    : robot_(robot), kept_(kLongestDelay + 1, Kept{first, kAlways}) {}

void LatestPlans::swap(std::size_t i, std::size_t j) {
  std::swap(kept_[i].plan.steps(), kept_[j].plan.steps());
  std::swap(kept_[i].ready, kept_[j].ready);
}

MpcPlan& LatestPlans::begin_next() {
  if (kept_.front().ready < kNever) {  // one that was dropped makes room itself
    for (std::size_t i = kept_.size() - 1; i > 0; --i) swap(i, i - 1);
  }
  kept_.front().ready = kAlways;
  return kept_.front().plan;
}

void LatestPlans::drop_latest() { act_from(kNever); }

/// Before any has begun, the one that begins first.
const MpcPlan& LatestPlans::acting(double t) const {
  const auto begin = [](const Kept& kept) { return std::max(kept.plan.start(), kept.ready); };
  const auto has_begun = [&](const Kept& kept) { return t >= begin(kept) - kTimeRounding; };
  const auto newest = std::ranges::find_if(kept_, has_begun);
  if (newest != kept_.end()) return newest->plan;
  return std::ranges::min_element(kept_, {}, begin)->plan;
}

bool LatestPlans::torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau) const {
  const MpcPlan& plan = acting(t);
  if (t <= plan.end()) {
    plan.torque(t, q, v, tau);
    return true;
  }
  damping_torques(robot_, q, v, tau);
  return false;
}

}  // namespace prowl
