#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "prowl/dynamics/projected_residual.hpp"
#include "prowl/linear_algebra/matrix_kernels.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/motion/friction_limit.hpp"
#include "prowl/transcription/hessian_kind.hpp"
#include "prowl/transcription/node/motion_limit.hpp"
#include "prowl/transcription/node/node_cost.hpp"
#include "prowl/transcription/node/node_point.hpp"
#include "prowl/transcription/node/placement_rows.hpp"
#include "prowl/transcription/node/term_costs.hpp"
#include "prowl/transcription/node/term_rows.hpp"
#include "prowl/transcription/node/torque_rows.hpp"

namespace prowl {

/// Smoothing eps of the friction cone's tip [N]. The cone asks for a normal force of eps / friction at least: eps is
/// set by the least load. Without one it is 1 % of the weight, 8.5 N for HyQ, as sharper tips cost iterations when a
/// foot lifts; less for low friction or many contacts, so all together carry at most a fifth of the weight.
double cone_smoothing(const MotionProblem& problem, const Phase& phase, const PhaseContact& contact);

/// Dependence of the contacts of a phase, determined once: see independent_contacts.hpp.
struct PhaseContacts {
  std::vector<int> chosen_rows;      ///< rows of the contact Jacobian with forces as variables
  std::vector<LandingAxes> landing;  ///< per contact of the phase
};

/// Rows on the placement of contacts: those that the schedule asks for, or those of
/// PlacementRows::motion_of_contacts().
enum class PlacementKind { of_schedule, motion_of_contacts };

/// Gains kd = rate / h + damping and kp = stiffness / h^2 + spring of the contact stabilisation,
/// for a step h (docs/transcription.md#contacts). The defaults, for the trapezoid, reduce an error
/// by a factor of three from node to node.
struct StabilisationOfStep {
  double rate = 2.0;
  double stiffness = 1.0;
  double damping = 0.0;  ///< [1/s]
  double spring = 0.0;   ///< [1/s^2]
};

/// Values at one node. Derivatives are in the variables of the node (base position, theta, joints |
/// v | a | tau | w), then in those shared by its phase (duration, if free | two surface coordinates
/// per free foothold).
struct NodeValues {
  double cost = 0.0;
  Eigen::VectorXd rows;
  Eigen::VectorXd forces;  ///< 3 per contact of the phase, world frame [N]
  Eigen::VectorXd cost_gradient;
  Eigen::MatrixXd rows_jacobian;
};

/// Cost and constraints at a node of one phase, with exact first and second derivatives. Rows:
///
///   dynamics (nv) | per contact: friction (FrictionLimit), or its force (3 rows, = 0) at the last node
///   if it opens | torque limits over position and velocity | placement of contacts (PlacementRows) | the user's terms
///   (TermRows)
///
/// Rows are divided by the scale of the robot, so one tolerance fits 2.5 kg and 80 kg: forces by
/// its weight, moments by its weight times RobotModel::size().
///
/// One object holds the work space of one thread. Evaluations do not allocate if the results
/// already have the right sizes, unless contacts lose rank.
class NodeFunctions {
 public:
  NodeFunctions(const DiscreteProblem& discrete, int phase, const PhaseContacts& contacts,
                const StabilisationOfStep& stabilisation = {}, PlacementKind placement = PlacementKind::of_schedule);

  /// Replaces q_ref (nq) and v_ref (nv) of running and terminal cost.
  void refer_to(const Eigen::VectorXd& q_ref, const Eigen::VectorXd& v_ref) { cost_.refer_to(q_ref, v_ref); }

  int num_variables() const { return 3 * nv_ + nu_ + num_chosen_; }  ///< of a node
  int num_shared() const { return (free_duration_ ? 1 : 0) + num_foothold_variables(); }
  int num_columns() const { return num_variables() + num_shared(); }
  bool has_free_duration() const { return free_duration_; }
  /// Contacts with a free foothold, as indices in the phase's list.
  const std::vector<int>& landed() const { return landed_; }
  const std::vector<Eigen::Matrix<double, 3, 2>>& landed_axes() const {
    return landed_axes_;
  }  ///< d anchor / d foothold coordinates

  int num_rows(int k) const { return term_row(k) + terms_.count(k); }
  int placement_row(int k) const { return torque_row(k) + torques_.count(); }  ///< first row of the placement
  int torque_row(int k) const { return contact_row(k, num_contacts()); }
  int contact_row(int k, int contact) const;  ///< first row of a contact, or the end of all
  int num_contacts() const { return static_cast<int>(friction_.size()); }
  int term_row(int k) const { return placement_row(k) + placement_.count(k); }
  double lower(int k, int row) const;
  double upper(int k, int row) const;
  std::string describe_row(int k, int row) const;
  /// The limit that a row represents; nullopt for dynamics, landings and forces before opening.
  /// Sets kind, subject, unit, si and size.
  std::optional<MotionLimit> limit_of_row(const RobotModel& robot, int k, int row) const;

  const std::vector<int>& contacts() const { return dynamics_.contacts(); }
  const std::vector<int>& chosen_rows() const { return dynamics_.chosen_rows(); }

  void evaluate(const NodePoint& point, NodeValues& values);
  void evaluate_with_derivatives(const NodePoint& point, NodeValues& values);
  /// Hessian of cost_factor * cost + multipliers . rows, in all columns, symmetric.
  void hessian(const NodePoint& point, double cost_factor, const Eigen::VectorXd& multipliers, Eigen::MatrixXd& result);
  /// Values, first derivatives and the Hessian of cost_factor * cost + multipliers . rows, with one
  /// evaluation of the dynamics. Of the Hessian the lower triangle; above it it is undefined.
  void linearise(const NodePoint& point, double cost_factor, const Eigen::VectorXd& multipliers, NodeValues& values,
                 Eigen::MatrixXd& hessian);

  /// Gains (kd, kp) at a node, or their derivative of order 1 or 2 in the duration of the phase.
  Eigen::Vector2d gains(const NodePoint& point, int derivative) const;
  /// Last evaluation: its point, and the kinematics there.
  const DynamicsPoint& at() const { return at_; }
  const RigidBodyTerms& kinematics() const { return dynamics_.terms(); }

  void use_hessian(HessianKind kind) { hessian_kind_ = kind; }  ///< of the above; default: exact
  HessianKind hessian_kind() const { return hessian_kind_; }

 private:
  int num_foothold_variables() const { return 2 * static_cast<int>(landed_.size()); }
  int first_foothold_variable() const { return num_variables() + (free_duration_ ? 1 : 0); }
  bool unloads(int k, int contact) const { return k == intervals_ && opens_[contact]; }

  void set_point(const NodePoint& point);
  void fill_rows(const NodePoint& point, NodeValues& values);
  void fill_derivatives(const NodePoint& point, NodeValues& values);
  /// Copies derivatives of residual or forces into all columns.
  void gather(const PointDerivatives& derivatives, const NodePoint& point, Eigen::Ref<Eigen::MatrixXd> result) const;
  // Parts of the Hessian, after fill_derivatives(): its lower triangle.
  void set_force_hessian(const NodePoint& point, double cost_factor, const Eigen::VectorXd& multipliers,
                         Eigen::MatrixXd& result);
  void add_cost_hessian(const NodePoint& point, double cost_factor, Eigen::MatrixXd& result);
  void add_dynamics_hessian(const NodePoint& point, const Eigen::VectorXd& multipliers, Eigen::MatrixXd& result);
  void add_limits_hessian(const NodePoint& point, const Eigen::VectorXd& multipliers, Eigen::MatrixXd& result);

  MatrixKernels kernels_;
  int nv_, nu_, num_chosen_, intervals_;
  HessianKind hessian_kind_ = HessianKind::exact;
  bool free_duration_;
  StabilisationOfStep stabilisation_;
  std::vector<double> per_gain_step_;  ///< at each node: duration of the phase over the step of its gains
  std::vector<double> times_;          ///< of each node, since the start of the motion [s]
  std::vector<std::string> contact_names_, force_names_;
  std::vector<bool> opens_;
  std::vector<int> landed_;
  std::vector<Eigen::Matrix<double, 3, 2>> landed_axes_;  ///< d anchor / d foothold coordinates, per entry of landed_
  std::vector<FrictionLimit> friction_;
  std::vector<double> coefficients_;  ///< of friction
  /// Margins of the contacts' cones, scaled, and of the joints' torques [N m]: a column for each node; empty if none.
  Eigen::MatrixXd cone_margins_, torque_margins_;
  TorqueRows torques_;
  PlacementRows placement_;
  TermRows terms_;
  NodeCost cost_;
  TermCosts term_costs_;
  ProjectedResidual dynamics_;
  double force_scale_;
  Eigen::VectorXd dynamics_scale_;  ///< nv
  // Work space.
  DynamicsPoint at_;
  NodeCost::Derivatives cost_derivatives_;
  double running_cost_ = 0.0;
  Eigen::MatrixXd forces_jacobian_, placement_anchors_;
  Eigen::MatrixXd bending_, bent_;                     ///< gradients of forces with curvature; times the curvature
  Eigen::VectorXd running_gradient_;                   ///< of the running cost, in the tangent of the rotation
  Eigen::Matrix<double, Eigen::Dynamic, 3> rotation_;  ///< of rows_jacobian, in the tangent of the rotation
  Eigen::Vector3d rotation_gradient_;                  ///< of the cost, likewise
  Eigen::VectorXd mu_, force_pull_, joints_, rates_;
  NodeValues unused_;         ///< values of hessian()
  Eigen::VectorXd on_cones_;  ///< multipliers without all others
};

}  // namespace prowl
