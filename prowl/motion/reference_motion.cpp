#include "prowl/motion/reference_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "prowl/model/body_placements.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/robot_frame.hpp"
#include "prowl/terms/deviation.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<int> first_entries(int count) {
  std::vector<int> entries;
  for (int i = 0; i < count; ++i) entries.push_back(i);
  return entries;
}

/// Costs over one motion.
class Costs {
 public:
  Costs(const ReferenceMotion& reference, int num_phases) : reference_(reference), last_phase_(num_phases - 1) {}

  /// `values`: of the entries, one column for each time of the reference.
  void add(const std::string& name, Quantity quantity, std::vector<int> entries, std::vector<std::string> rows,
           std::string unit, MatrixXd values, const VectorXd& weights) {
    if (weights.isZero(0.0)) return;
    TermUse& use = uses_.emplace_back();
    use.name = "reference " + name;
    use.term = deviation(std::move(quantity), std::move(entries), std::move(rows), std::move(unit),
                         {reference_.times, std::move(values)});
    use.from = PhaseFraction::start_of(0);
    use.to = PhaseFraction::end_of(last_phase_);
    use.reference.setZero(weights.size());
    use.weight = weights.asDiagonal();
  }
  std::vector<TermUse> take() { return std::move(uses_); }

 private:
  const ReferenceMotion& reference_;
  int last_phase_;
  std::vector<TermUse> uses_;
};

/// The axes of the base, one after the other, in each posture.
MatrixXd base_axes(const ReferenceMotion& reference) {
  MatrixXd axes(9, reference.times.size());
  for (Index k = 0; k < axes.cols(); ++k) axes.col(k) = base_rotation(reference.q.col(k)).reshaped();
  return axes;
}

MatrixXd frame_positions(const RobotModel& robot, const ReferenceMotion& reference, const std::string& name) {
  const RobotFrame frame = robot_frame(robot, name);
  BodyPlacements bodies(robot);
  MatrixXd positions(3, reference.times.size());
  for (Index k = 0; k < positions.cols(); ++k) {
    positions.col(k) = bodies.at(reference.q.col(k))[frame.body] * frame.placement.translation();
  }
  return positions;
}

}  // namespace

VectorXd ReferenceMotion::at(double time) const {
  const Index after = std::ranges::upper_bound(times, time) - times.begin();
  if (after == 0) return q.col(0);
  if (after == times.size()) return q.col(after - 1);
  const double share = (time - times(after - 1)) / (times(after) - times(after - 1));
  const VectorXd before = q.col(after - 1);
  return integrate(before, share * difference(before, q.col(after)));
}

std::vector<TermUse> reference_costs(const RobotModel& robot, const ReferenceMotion& reference,
                                     const ReferenceWeights& weights, int num_phases) {
  using Kind = Quantity::Kind;
  const std::vector<std::string> xyz = {"x", "y", "z"};
  Costs costs(reference, num_phases);
  costs.add("base_position", {Kind::position, kBaseFrame}, first_entries(3), xyz, "m", reference.q.topRows<3>(),
            weights.base_position);
  // Half of the sum of squares over all axes: 2 - 2 cos(angle), without the jump of a rotation vector at half a turn.
  std::vector<std::string> axes;
  for (const char* axis : {"x", "y", "z"}) {
    for (const std::string& entry : xyz) axes.push_back(fmt::format("axis {}, {}", axis, entry));
  }
  costs.add("base_orientation", {Kind::orientation, kBaseFrame}, first_entries(9), axes, "-", base_axes(reference),
            VectorXd::Constant(9, 0.5 * weights.base_orientation));
  costs.add("joint_position", {.kind = Kind::joints}, first_entries(robot.nu()), robot.joint_names(), "rad",
            reference.q.bottomRows(robot.nu()), weights.joint_position);
  for (const auto& [name, weight] : weights.frames) {
    costs.add(name, {Kind::position, name}, first_entries(3), xyz, "m", frame_positions(robot, reference, name),
              Eigen::Vector3d::Constant(weight));
  }
  return costs.take();
}

}  // namespace prowl
