#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "tests/support/zero_cost.hpp"

namespace prowl::test {

/// A motion of a robot on all its contacts that is exact at every instant: the base moves there and back by the given
/// displacement and rotation, at rest at both ends; joints, torques and forces (of least norm) follow from the contacts
/// that stay where they are and from the equations of motion. With neither it stands still.
class StanceMotion {
 public:
  StanceMotion(RobotModel robot, double duration, const Eigen::Vector3d& displacement, const Eigen::Vector3d& rotation)
      : robot_(std::move(robot)),
        duration_(duration),
        displacement_(displacement),
        rotation_(rotation),
        terms_(robot_),
        kinematics_(all_contacts()) {
    terms_.update_kinematics(robot_.nominal_configuration());
    for (int contact : all_contacts()) targets_.push_back({contact, terms_.contact_position(contact)});
    q_ = robot_.nominal_configuration();
  }

  const RobotModel& robot() const { return robot_; }
  std::vector<int> all_contacts() const {
    std::vector<int> contacts(robot_.contacts().size());
    for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i] = static_cast<int>(i);
    return contacts;
  }

  TrajectoryPoint at(double time) {
    const double w = 2.0 * std::numbers::pi / duration_;
    const double s = 0.5 * (1.0 - std::cos(w * time)), ds = 0.5 * w * std::sin(w * time),
                 dds = 0.5 * w * w * std::cos(w * time);
    TrajectoryPoint point;
    point.time = time;
    move_base(s);
    point.q = q_;
    const Eigen::Matrix3d to_base = base_rotation(point.q).transpose();
    Eigen::Matrix<double, 6, 1> base_v, base_a;
    base_v << ds * (to_base * displacement_), ds * rotation_;
    base_a << dds * (to_base * displacement_) - base_v.tail<3>().cross(base_v.head<3>()), dds * rotation_;
    point.v = with_fixed_contacts(point.q, Eigen::VectorXd::Zero(robot_.nv()), base_v);
    point.a = with_fixed_contacts(point.q, point.v, base_a);
    add_forces(point);
    return point;
  }

  /// At the nodes of a mesh; the trapezoid misses each by O(h³).
  Trajectory on_mesh(int intervals) {
    Trajectory trajectory;
    for (int k = 0; k <= intervals; ++k) trajectory.nodes.push_back(at(duration_ * k / intervals));
    return trajectory;
  }

  /// The same configurations, with the velocities and accelerations by which the trapezoid meets every node. They are
  /// off by O(h²), and so is what holds the contacts: like the solution of a transcription.
  Trajectory by_trapezoid(int intervals) {
    Trajectory trajectory = on_mesh(intervals);
    const double h = duration_ / intervals;
    for (int k = 0; k < intervals; ++k) {
      const TrajectoryPoint& left = trajectory.nodes[k];
      TrajectoryPoint& right = trajectory.nodes[k + 1];
      const Eigen::VectorXd start = integrate(left.q, 0.5 * h * tangent_rate(left));
      right.v = 2.0 / h * difference(start, right.q);
      right.v.head<3>() = base_rotation(right.q).transpose() * right.v.head<3>();
      right.a = 2.0 / h * (right.v - left.v) - left.a;
      add_forces(right);
    }
    return trajectory;
  }

  void add_forces(TrajectoryPoint& point) { add_forces(point, all_contacts()); }

  /// Torques and forces of least norm at (q, v, a), with forces at `held` only.
  void add_forces(TrajectoryPoint& point, const std::vector<int>& held) {
    terms_.update(point.q, point.v, point.a);
    kinematics_.set_configuration(terms_);
    const Eigen::VectorXd& r = terms_.inverse_dynamics();
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(kinematics_.rows(), robot_.nv());
    for (const int c : held) J.middleRows<3>(3 * c) = kinematics_.jacobian().middleRows<3>(3 * c);
    point.force = J.leftCols(6).transpose().completeOrthogonalDecomposition().solve(r.head(6));
    point.tau = r.tail(robot_.nu()) - J.rightCols(robot_.nu()).transpose() * point.force;
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& q) {
    terms_.update_kinematics(q);
    kinematics_.set_configuration(terms_);
    return kinematics_.jacobian();
  }

 private:
  void move_base(double s) {
    const Eigen::VectorXd& home = robot_.nominal_configuration();
    q_.head<3>() = home.head<3>() + s * displacement_;
    set_base_rotation(q_, base_rotation(home) * so3::exp(s * rotation_));
    // To rounding, far below the tolerance of one call: the contacts stay where they are.
    const InverseKinematics solution = inverse_kinematics(robot_, q_, targets_);
    if (!solution.converged) throw std::runtime_error("the contacts are out of reach");
    q_ = solution.q;
    for (int i = 0; i < 2; ++i) {
      const Eigen::MatrixXd J = jacobian(q_).rightCols(robot_.nu());
      Eigen::VectorXd error(J.rows());
      for (std::size_t c = 0; c < targets_.size(); ++c) {
        error.segment<3>(3 * static_cast<Eigen::Index>(c)) =
            targets_[c].position - terms_.contact_position(targets_[c].contact);
      }
      q_.tail(robot_.nu()) += J.completeOrthogonalDecomposition().solve(error);
    }
  }

  /// x = (base, joints) with J x + J̇ v = 0: velocities for v = 0, accelerations for the v that they go with.
  Eigen::VectorXd with_fixed_contacts(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                      const Eigen::Matrix<double, 6, 1>& base) {
    const Eigen::MatrixXd J = jacobian(q);
    kinematics_.set_motion(v, Eigen::VectorXd::Zero(robot_.nv()));
    Eigen::VectorXd x(robot_.nv());
    x << base, J.rightCols(robot_.nu())
                   .completeOrthogonalDecomposition()
                   .solve(-J.leftCols(6) * base - kinematics_.acceleration());
    return x;
  }

  RobotModel robot_;
  double duration_;
  Eigen::Vector3d displacement_, rotation_;
  RigidBodyTerms terms_;
  ContactKinematics kinematics_;
  std::vector<ContactTarget> targets_;
  Eigen::VectorXd q_;
};

inline BoundaryConstraint free_constraint(const RobotModel& robot, std::string name, PhaseFraction at,
                                          const Eigen::VectorXd& q_ref) {
  const double inf = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd state = Eigen::VectorXd::Constant(robot.nv(), inf);
  const Eigen::VectorXd torque = Eigen::VectorXd::Constant(robot.nu(), inf);
  return {std::move(name), at, q_ref, -state, state, -state, state, -torque, torque};
}

/// Prescribes q = q_ref and v.
inline BoundaryConstraint fixed_state(const RobotModel& robot, std::string name, PhaseFraction at,
                                      const Eigen::VectorXd& q_ref, const Eigen::VectorXd& v) {
  BoundaryConstraint constraint = free_constraint(robot, std::move(name), at, q_ref);
  constraint.configuration_lower.setZero();
  constraint.configuration_upper.setZero();
  constraint.velocity_lower = constraint.velocity_upper = v;
  return constraint;
}

/// The problem that `trajectory` (one phase, all contacts) solves: its ends are start and goal.
inline MotionProblem problem_of(const RobotModel& robot, const Trajectory& trajectory) {
  Phase phase;
  phase.name = "stance";
  for (std::size_t c = 0; c < robot.contacts().size(); ++c) phase.contacts.push_back({static_cast<int>(c), 0});
  phase.duration = {trajectory.duration(), trajectory.duration()};
  const TrajectoryPoint &first = trajectory.nodes.front(), &last = trajectory.nodes.back();
  return {.name = "stance",
          .robot = robot,
          .surfaces = {Surface{}},
          .phases = {phase},
          .boundary_constraints = {fixed_state(robot, "start", PhaseFraction::start_of(0), first.q, first.v),
                                   fixed_state(robot, "goal", PhaseFraction::end_of(0), last.q, last.v)},
          .running_cost = zero_cost(robot),
          .terminal_cost = zero_cost(robot),
          .goal_tolerance = {}};
}

}  // namespace prowl::test
