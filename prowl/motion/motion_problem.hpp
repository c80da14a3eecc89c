#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/model/surface.hpp"
#include "prowl/motion/cost.hpp"
#include "prowl/motion/friction_limit.hpp"
#include "prowl/motion/margins.hpp"
#include "prowl/motion/phase.hpp"
#include "prowl/motion/reference_motion.hpp"
#include "prowl/motion/term_use.hpp"

namespace prowl {

/// Bounds on state and torque at one moment; -inf and +inf where free, equal where prescribed.
///
///   configuration_lower <= difference(q_ref, q) <= configuration_upper     (nv; base displacement in the world frame,
///                                                   rotation vector in the frame of q_ref, joints)
///   velocity_lower <= v <= velocity_upper (nv),   torque_lower <= tau <= torque_upper (nu)
///
/// The start of a motion is one of these at the start of the first phase; a goal is one at any moment. Contacts of the
/// first phase stand where q_ref of the start puts them: where the bounds leave a choice, the optimiser moves the body
/// over these places.
struct BoundaryConstraint {
  std::string name;  ///< "start", "goal 1", ... for messages
  PhaseFraction at;
  Eigen::VectorXd q_ref;  ///< nq
  Eigen::VectorXd configuration_lower, configuration_upper;
  Eigen::VectorXd velocity_lower, velocity_upper;
  Eigen::VectorXd torque_lower, torque_upper;

  /// A condition without bounds, about q_ref.
  static BoundaryConstraint unbounded(const RobotModel& robot, std::string name, PhaseFraction at,
                                      const Eigen::VectorXd& q_ref);
  bool fixes_configuration() const { return configuration_lower == configuration_upper; }
  bool fixes_velocity() const { return velocity_lower == velocity_upper; }
};

/// A motion that repeats itself: the state at the end of each cycle is that at its start, taken along. A place p goes
/// to Rz(turn) p + displacement; velocities in the base frame and joints stay.
struct Cycle {
  int count = 1;                                           ///< cycles of the motion, equal parts of its phases
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< [m]
  double turn = 0.0;                                       ///< about the vertical [rad]

  Eigen::Matrix3d rotation() const { return Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix(); }
  Eigen::Vector3d moved(const Eigen::Vector3d& place) const { return rotation() * place + displacement; }
  Eigen::VectorXd moved_configuration(const Eigen::VectorXd& q) const;  ///< nq
};

/// Tolerances of the certificate on goals [m, rad, m/s and rad/s].
struct GoalTolerance {
  double position = 1e-3;
  double angle = 1e-3;
  double velocity = 5e-3;
};

/// Default swing clearance, as a part of the standing height.
constexpr double kSwingClearanceShare = 0.05;

/// Default least load of a held contact, as a share of its even load: docs/simulated-tasks.md.
constexpr double kLeastLoadShare = 0.2;

/// Everything that defines a motion, before any discretisation.
/// All limits of the robot (joint position, velocity, torque) and of the surfaces (friction, unilateral force) are
/// hard.
struct MotionProblem {
  std::string name;
  RobotModel robot;
  std::vector<Surface> surfaces;
  std::vector<Phase> phases;
  std::vector<BoundaryConstraint> boundary_constraints;  ///< the first is the start
  QuadraticCost running_cost;
  QuadraticCost terminal_cost;
  std::vector<TermUse> terms = {};  ///< costs and limits of the user's own
  std::shared_ptr<const ReferenceMotion> reference =
      {};  ///< where the initial guess is from; null: boundary constraints
  FrictionModel friction_model = FrictionModel::cone;
  double swing_clearance = 0.0;  ///< of contacts above the surfaces, in the middle of a swing [m]
  bool stands_at_end = false;    ///< the base does not accelerate at the end, so the last forces go on to hold it
  double least_load = 0.0;       ///< of each held contact, as a share of its even load [-]: least_load()
  Margins margins = {};          ///< of the limits; none by default
  GoalTolerance goal_tolerance;
  std::optional<Cycle> cycle = {};  ///< with it, the start is free, and footholds move from cycle to cycle

  int phases_of_cycle() const { return static_cast<int>(phases.size()) / cycle->count; }  ///< only with a cycle
  const BoundaryConstraint& start() const { return boundary_constraints.front(); }
  const Eigen::VectorXd& start_configuration() const { return start().q_ref; }
};

/// Moments at which a mesh must have a node: those of start and goals, and both ends of terms.
std::vector<PhaseFraction> node_moments(const MotionProblem& problem);

/// True if a goal stops the base at the end of the last phase, and the motion does not repeat itself.
bool ends_at_rest(const MotionProblem& problem);

/// True if it ends at rest on contacts that can balance the base: three or more.
bool can_stand_at_end(const MotionProblem& problem);

/// Normal force [N] that a contact of this phase carries at least, but in the interval before it opens: its share of an
/// even load. Even: the weight, times the cosine of the surface's slope, over the number of contacts.
double least_load(const MotionProblem& problem, const Phase& phase, const PhaseContact& contact);

/// Throws InputError that names the field unless sizes, indices, ranges and finiteness are right and the start is
/// inside the joint limits, with the contacts of the first phase on their surfaces (within 1 mm) and, where it is
/// fixed, at rest (1 mm/s).
void validate(const MotionProblem& problem);

}  // namespace prowl
