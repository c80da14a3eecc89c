#include "prowl/tracking/make_tracking_plan.hpp"

#include <algorithm>

namespace prowl {
namespace {

/// Samples a curve densely: linear interpolation errs by less than the rounding in a robot file.
TrackingPlan::TorqueCurve tabulated(const RobotModel::TorqueCurve& limit, TrackingPlan::Torques torques) {
  constexpr int kValues = 513;
  const LimitCurve& curve = torques == TrackingPlan::Torques::negative ? limit.negative : limit.positive;
  TrackingPlan::TorqueCurve table{limit.joint, limit.over_velocity, torques, curve.lower_end(), curve.upper_end(), {}};
  table.values = Eigen::VectorXd::LinSpaced(kValues, table.lower, table.upper).unaryExpr([&](double x) {
    return std::max(curve.value(x), 0.0);
  });
  return table;
}

}  // namespace

TrackingPlan make_tracking_plan(const MotionProblem& problem, const FeedbackDesign& design) {
  const RobotModel& robot = problem.robot;
  TrackingPlan plan;
  plan.joint_names = robot.joint_names();
  for (const ContactPoint& contact : robot.contacts()) plan.contact_names.push_back(contact.name);
  plan.torque_limit = robot.torque_limit();
  for (const RobotModel::TorqueCurve& limit : robot.torque_curves()) {
    for (const auto torques : {TrackingPlan::Torques::positive, TrackingPlan::Torques::negative})
      plan.torque_curves.push_back(tabulated(limit, torques));
  }

  int samples = 0;
  for (const ReferencePhase& phase : design.phases) {
    TrackingPlan::Segment& segment = plan.segments.emplace_back();
    segment.name = phase.name;
    segment.start = phase.start();
    segment.end = phase.end();
    segment.first_sample = samples;
    segment.samples = static_cast<int>(phase.samples.size());
    segment.in_contact.assign(robot.contacts().size(), false);
    for (const int contact : phase.contacts) segment.in_contact[contact] = true;
    samples += segment.samples;
  }
  plan.q.resize(robot.nq(), samples);
  plan.v.resize(robot.nv(), samples);
  plan.tau.resize(robot.nu(), samples);
  plan.gains.resize(2L * robot.nu() * robot.nv(), samples);
  Eigen::Index column = 0;
  for (std::size_t p = 0; p < design.phases.size(); ++p) {
    for (std::size_t k = 0; k < design.phases[p].samples.size(); ++k, ++column) {
      const TrajectoryPoint& point = design.phases[p].samples[k];
      plan.q.col(column) = point.q;
      plan.q.block<4, 1>(3, column).normalize();
      plan.v.col(column) = point.v;
      plan.tau.col(column) = point.tau + robot.losses().torques(point.v.tail(robot.nu()));
      plan.gains.col(column) = design.gains[p][k].reshaped();
    }
  }
  return plan;
}

}  // namespace prowl
