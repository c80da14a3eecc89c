#pragma once

#include <cmath>
#include <numbers>

#include "prowl/certificate/constrained_dynamics_oracle.hpp"
#include "tests/certificate/certificate_cases.hpp"

namespace prowl::test {

/// HyQ stands still but for its left front leg: the load goes off the foot (phase 0, all feet), the foot is lifted by
/// the knee and put back (phase 1, three feet), and takes its load again (phase 2, on surface 1, a patch around it).
/// The mesh is fine; the trapezoid meets every node.
class SteppingMotion {
 public:
  static constexpr int kFoot = 0, kKnee = 2;                   // lf_foot, lf_kfe_joint
  static constexpr int kShift = 10, kSwing = 300;              // intervals
  static constexpr double kShiftTime = 0.5, kSwingTime = 0.6;  // [s]

  /// The centre of mass is over the other three feet.
  explicit SteppingMotion(RobotModel robot)
      : motion_(std::move(robot), 1.0, {-0.08, -0.06, -0.02}, Eigen::Vector3d::Zero()), posture_(motion_.at(0.5)) {
    posture_.v.setZero();
    posture_.a.setZero();
  }

  Case make() {
    Trajectory trajectory;
    add_shift(trajectory, 0, 1.0, 0.0);
    add_swing(trajectory);
    add_shift(trajectory, 2, 0.0, 1.0);
    MotionProblem problem = problem_of(motion_.robot(), trajectory);
    problem.boundary_constraints[1].at = PhaseFraction::end_of(2);
    const Phase stance = problem.phases[0];
    problem.phases = {stance, stance, stance};
    problem.phases[1].contacts.erase(problem.phases[1].contacts.begin());
    problem.phases[0].duration = problem.phases[2].duration = {kShiftTime, kShiftTime};
    problem.phases[1].duration = {kSwingTime, kSwingTime};
    problem.phases[2].contacts[0].surface = 1;
    problem.phases[2].contacts[0].foothold = step_foothold();
    problem.surfaces.push_back(patch_around(step_foothold(), 0.03));
    problem.swing_clearance = 0.05;
    Mesh mesh{{PhaseMesh(kShift), PhaseMesh(kSwing), PhaseMesh(kShift)}};
    return {{std::move(problem), std::move(mesh)}, std::move(trajectory)};
  }

  /// Where the foot's ball touches the floor.
  Eigen::Vector3d step_foothold() {
    ConstrainedDynamicsOracle oracle(motion_.robot(), {});
    Eigen::Vector3d foothold = oracle.contact_points(posture_.q, posture_.v).position.col(kFoot);
    foothold.z() -= motion_.robot().contacts()[kFoot].radius;
    return foothold;
  }

  static Surface patch_around(const Eigen::Vector3d& centre, double half) {
    Surface surface{.name = "patch", .point = centre};
    surface.patch = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
    return surface;
  }

 private:
  /// The posture at rest with part `load` of what the foot carries when all four do.
  TrajectoryPoint standing_with(double load) {
    TrajectoryPoint on_four = posture_, on_three = posture_;
    motion_.add_forces(on_four);
    motion_.add_forces(on_three, {1, 2, 3});
    on_three.tau += load * (on_four.tau - on_three.tau);
    on_three.force += load * (on_four.force - on_three.force);
    return on_three;
  }

  void add_shift(Trajectory& trajectory, int phase, double from, double to) {
    const double start = trajectory.duration();
    for (int k = 0; k <= kShift; ++k) {
      const double s = static_cast<double>(k) / kShift;
      TrajectoryPoint point = standing_with(from + s * (to - from));
      point.time = start + kShiftTime * s;
      point.phase = phase;
      trajectory.nodes.push_back(point);
    }
  }

  /// The knee's acceleration is one period of a cosine: the trapezoid, too, brings it back to rest where it was.
  void add_swing(Trajectory& trajectory) {
    const double start = trajectory.duration(), h = kSwingTime / kSwing;
    TrajectoryPoint point = posture_;
    point.phase = 1;
    for (int k = 0; k <= kSwing; ++k) {
      const TrajectoryPoint before = point;
      point.a(6 + kKnee) = -20.0 * std::cos(2.0 * std::numbers::pi * k / kSwing);  // [rad/s²], bends further
      if (k > 0) point.v += 0.5 * h * (before.a + point.a);
      if (k > 0) point.q(7 + kKnee) += 0.5 * h * (before.v + point.v)(6 + kKnee);
      point.time = start + h * k;
      motion_.add_forces(point, {1, 2, 3});
      trajectory.nodes.push_back(point);
    }
  }

  StanceMotion motion_;
  TrajectoryPoint posture_;
};

}  // namespace prowl::test
