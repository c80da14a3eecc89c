#include "prowl/trajectory/trajectory.hpp"

#include <algorithm>
#include <iterator>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/trajectory/hermite_interval.hpp"

namespace prowl {

const char* to_string(Interpolation interpolation) {
  return interpolation == Interpolation::trapezoid ? "trapezoid" : "hermite";
}

Eigen::VectorXd tangent_rate(const TrajectoryPoint& point) {
  Eigen::VectorXd rate = point.v;
  rate.head<3>() = base_rotation(point.q) * point.v.head<3>();
  return rate;
}

TrajectoryPoint interpolate(const TrajectoryPoint& left, const TrajectoryPoint& right, double s) {
  const double h = right.time - left.time;
  const double late = s / h;            // weight of the right node
  const double beta = s * s / (2 * h);  // integral of `late` from 0 to s [s]
  const double alpha = s - beta;        // integral of 1 - late

  TrajectoryPoint point;
  point.time = left.time + s;
  point.phase = left.phase;
  point.a = (1 - late) * left.a + late * right.a;
  point.tau = (1 - late) * left.tau + late * right.tau;
  point.force = (1 - late) * left.force + late * right.force;
  point.v = left.v + alpha * left.a + beta * right.a;
  point.q = integrate(integrate(left.q, alpha * tangent_rate(left)), beta * tangent_rate(right));
  return point;
}

Eigen::VectorXd interpolated_rate(const TrajectoryPoint& left, const TrajectoryPoint& right, double s) {
  const double late = s / (right.time - left.time);
  Eigen::VectorXd rate = (1 - late) * tangent_rate(left) + late * tangent_rate(right);
  // R = R_k exp(α w_k) exp(β w_{k+1}) turns at  exp(-β w_{k+1}) α̇ w_k + β̇ w_{k+1},  α̇ = 1 - late, β̇ = late.
  const Eigen::Vector3d w_right = right.v.segment<3>(3);
  const double beta = 0.5 * s * late;
  rate.segment<3>(3) = (1 - late) * so3::exp(-beta * w_right) * left.v.segment<3>(3) + late * w_right;
  return rate;
}

TrajectoryPoint sample(const Trajectory& trajectory, double t) {
  const auto& nodes = trajectory.nodes;
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), t,
                                      [](double time, const TrajectoryPoint& node) { return time < node.time; });
  if (after == nodes.begin()) return nodes.front();
  const auto before = std::prev(after);  // at a phase transition, the node of the later phase
  if (after == nodes.end() || t == before->time) return *before;
  const double s = t - before->time;
  if (trajectory.interpolation == Interpolation::trapezoid) return interpolate(*before, *after, s);
  // Phase transitions before it are not intervals.
  const auto interval = static_cast<std::size_t>(before - nodes.begin() - (before->phase - nodes.front().phase));
  return hermite_point(*before, *after,
                       trajectory.middle_torques.empty() ? nullptr : &trajectory.middle_torques[interval], s);
}

}  // namespace prowl
