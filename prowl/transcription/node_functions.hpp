#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/dynamics/projected_residual.hpp"
#include "prowl/motion/contact_schedule.hpp"
#include "prowl/motion/friction_limit.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/transcription/node_cost.hpp"
#include "prowl/transcription/node_point.hpp"
#include "prowl/transcription/placement_rows.hpp"
#include "prowl/transcription/torque_rows.hpp"

namespace prowl {

/// How the contacts of a phase depend on each other, settled once: see independent_contacts.hpp.
struct PhaseContacts {
  std::vector<int> chosen_rows;      ///< rows of the contact Jacobian whose forces are variables
  std::vector<LandingAxes> landing;  ///< one a contact of the phase
};

/// What is evaluated at one node. Derivatives are in the variables of the node (base position, theta, joints | v | a |
/// tau | w) and then in what its phase shares (duration, if free | two surface coordinates of each contact that landed).
struct NodeValues {
  double cost = 0.0;
  Eigen::VectorXd rows;
  Eigen::VectorXd forces;         ///< 3 per contact of the phase, world frame [N]
  Eigen::VectorXd cost_gradient;
  Eigen::MatrixXd rows_jacobian;
};

/// Everything that holds at a node of one phase, with exact first and second derivatives. Rows:
///
///   dynamics, nv | contacts: friction (FrictionLimit), or at the last node of a contact that opens its force (three rows, = 0) |
///   torque limits over position and velocity | places of contacts (PlacementRows)
///
/// Rows are scaled by the size of the robot, so that one tolerance means the same for 2.5 kg and for 80 kg: forces by its
/// weight, moments by its weight times RobotModel::size().
class NodeFunctions {
 public:
  NodeFunctions(const MotionProblem& problem, const ContactSchedule& schedule, int phase, const PhaseContacts& contacts);

  int num_variables() const { return 3 * nv_ + nu_ + num_chosen_; }        ///< of a node
  int num_shared() const { return (free_duration_ ? 1 : 0) + num_places(); }
  int num_columns() const { return num_variables() + num_shared(); }
  bool has_free_duration() const { return free_duration_; }
  /// Contacts of the phase whose place is shared variables, in their order: places in the phase's list.
  const std::vector<int>& landed() const { return landed_; }

  int num_rows(int k) const { return placement_row(k) + placement_.count(k); }
  double lower(int k, int row) const;
  double upper(int k, int row) const;
  std::string describe_row(int k, int row) const;

  const std::vector<int>& contacts() const { return dynamics_.contacts(); }
  const std::vector<int>& chosen_rows() const { return dynamics_.chosen_rows(); }

  void evaluate(const NodePoint& point, NodeValues& values);
  void evaluate_with_derivatives(const NodePoint& point, NodeValues& values);
  /// Hessian of cost_factor * cost + multipliers . rows, in all columns, symmetric.
  void hessian(const NodePoint& point, double cost_factor, const Eigen::VectorXd& multipliers, Eigen::MatrixXd& result);
  void linearise(const NodePoint& point, double cost_factor, const Eigen::VectorXd& multipliers, NodeValues& values, Eigen::MatrixXd& result) {
    evaluate_with_derivatives(point, values); hessian(point, cost_factor, multipliers, result);
  }

 private:
  int num_places() const { return 2 * static_cast<int>(landed_.size()); }
  int first_place() const { return num_variables() + (free_duration_ ? 1 : 0); }
  int num_contacts() const { return static_cast<int>(friction_.size()); }
  bool unloads(int k, int contact) const { return k == intervals_ && opens_[static_cast<std::size_t>(contact)]; }
  int contact_row(int k, int contact) const;  ///< first row of a contact, or the end of them all
  int torque_row(int k) const { return contact_row(k, num_contacts()); }
  int placement_row(int k) const { return torque_row(k) + torques_.count(); }

  DynamicsPoint dynamics_point(const NodePoint& point) const;
  /// Gains (kd, kp) of a step, their first and second derivatives in the duration of the phase.
  Eigen::Vector2d gains(double duration, int derivative) const;
  void fill_rows(const NodePoint& point, NodeValues& values);
  /// Columns of a block of derivatives of residual or forces in all columns.
  void gather(const PointDerivatives& derivatives, Eigen::Ref<Eigen::MatrixXd> result, double duration) const;

  int nv_, nu_, num_chosen_, intervals_;
  bool free_duration_;
  std::vector<std::string> contact_names_, force_names_;
  std::vector<bool> opens_;
  std::vector<int> landed_;
  Eigen::MatrixXd anchor_axes_;  ///< derivative of the anchors in the places
  std::vector<FrictionLimit> friction_;
  TorqueRows torques_;
  PlacementRows placement_;
  NodeCost cost_;
  ProjectedResidual dynamics_;
  double force_scale_;
  Eigen::VectorXd dynamics_scale_;  ///< nv
  Eigen::MatrixXd forces_jacobian_;
  NodeCost::Derivatives cost_derivatives_;
};

}  // namespace prowl
