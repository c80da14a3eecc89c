#include "prowl/tracking/rollout_measures.hpp"

#include <algorithm>

#include "prowl/model/torque_share.hpp"
#include "prowl/trajectory/worst_moment.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// Accumulates the load of each contact.
class ContactLoads {
 public:
  ContactLoads(const MotionProblem& problem, std::optional<double> friction)
      : problem_(problem), friction_(friction), worst_(problem.robot.contacts().size()) {}

  void record(const RolloutSample& sample) {
    // After the end the contacts are those of the last phase.
    const std::size_t phase = std::min(static_cast<std::size_t>(sample.segment), problem_.phases.size() - 1);
    for (const PhaseContact& held : problem_.phases[phase].contacts) {
      const Surface& surface = problem_.surfaces[held.surface];
      const Eigen::Vector3d force = sample.force.segment<3>(3 * held.contact);
      const double normal = surface.normal.dot(force);
      const double tangential = (force - normal * surface.normal).norm();
      Worst& worst = worst_[held.contact];
      worst.stood = true;
      worst.pull.record(-normal, sample.time, "");
      worst.beyond.record(tangential - friction_.value_or(surface.friction) * std::max(normal, 0.0), sample.time, "");
    }
  }

  std::vector<ContactLoad> loads() const {
    std::vector<ContactLoad> loads;
    for (const Worst& worst : worst_) {
      loads.push_back({worst.stood, -worst.pull.worst, worst.pull.time, worst.beyond.worst, worst.beyond.time});
    }
    return loads;
  }

 private:
  struct Worst {
    bool stood = false;
    WorstMoment pull, beyond;
  };
  const MotionProblem& problem_;
  std::optional<double> friction_;
  std::vector<Worst> worst_;
};

}  // namespace

RolloutMeasures measure_rollout(const MotionProblem& problem, const Tracker& tracker, const Rollout& rollout,
                                double end, std::optional<double> friction) {
  constexpr double kAtLimit = 0.999;  // of a torque curve, which the tracker tabulates
  const RobotModel& robot = problem.robot;
  TrackingError error;
  WorstMoment torque;
  ContactLoads loads(problem, friction);
  RolloutMeasures measures;
  long saturated = 0;
  VectorXd q_ref(robot.nq()), v_ref(robot.nv());
  for (std::size_t i = 0; i < rollout.samples.size(); ++i) {
    const RolloutSample& at = rollout.samples[i];
    tracker.reference(at.time, q_ref, v_ref);
    error.add(q_ref, at.q, at.time >= end - kRestWindow);
    double largest = 0.0;
    for (int j = 0; j < robot.nu(); ++j) {
      const double share = torque_share(robot, j, at.q(7 + j), at.v(6 + j), at.tau(j));
      torque.record(share, at.time, robot.joint_names()[j]);
      largest = std::max(largest, share);
    }
    if (largest >= kAtLimit) ++saturated;
    if (i + 1 < rollout.samples.size()) {
      measures.positive_work +=
          (rollout.samples[i + 1].time - at.time) * at.tau.cwiseProduct(at.v.tail(robot.nu())).cwiseMax(0.0).sum();
    }
    loads.record(at);
  }
  measures.base_position = error.base_position();
  measures.base_angle = error.base_angle();
  measures.joints = error.joints();
  measures.largest_torque_share = torque.worst;
  measures.largest_torque_joint = torque.where;
  measures.saturated =
      rollout.samples.empty() ? 0.0 : static_cast<double>(saturated) / static_cast<double>(rollout.samples.size());
  measures.contacts = loads.loads();
  return measures;
}

}  // namespace prowl
