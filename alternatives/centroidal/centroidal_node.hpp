#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "alternatives/centroidal/centroidal_contacts.hpp"
#include "alternatives/centroidal/centroidal_layout.hpp"
#include "alternatives/centroidal/sparse_entries.hpp"
#include "prowl/dynamics/centroidal_kinematics.hpp"
#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/motion/friction_limit.hpp"
#include "prowl/transcription/node/node_cost.hpp"
#include "prowl/transcription/node/placement_rows.hpp"

namespace prowl {

/// A number of rows or variables of one kind.
struct RowGroup {
  std::string name;
  int count = 0;
};

/// Scales of the rows, so that one tolerance fits every robot.
struct CentroidalScale {
  explicit CentroidalScale(const RobotModel& robot);
  double length;    ///< size l of the robot [m]
  double speed;     ///< sqrt(g l) [m/s]
  double force;     ///< weight [N]
  double momentum;  ///< angular, mass speed l [kg m^2/s]
};

/// Variables x of one node, in the order of CentroidalColumns, and other inputs of its functions.
struct CentroidalPoint {
  int node = 0;  ///< within its phase
  Eigen::VectorXd x;
  Eigen::Matrix3d chart;         ///< R = chart exp(theta)
  double duration = 0.0;         ///< of the phase [s]
  double cost_weight = 0.0;      ///< of the running cost: the step before the node [s]
  double terminal_weight = 0.0;  ///< of the terminal cost: 1 at the last node
};

struct CentroidalValues {
  double cost = 0.0;
  Eigen::VectorXd rows;
  Eigen::VectorXd cost_gradient;  ///< in x, then in the duration
  SparseEntries jacobian;         ///< of the rows in x
};

/// Cost and constraints at the nodes of one phase, with exact first and second derivatives. Rows,
/// in this order:
///
///   m r'' = sum f + m g,  h' = sum (c - r) x f                      where an interval ends
///   h = A_G(q) v (angular),  r = com(q),  c = p(q)                  everywhere
///   distance of contacts to their surfaces                          except staying contacts at a first node
///   friction cones, or f = 0 at the last node of a contact that opens
///   r' = velocity of com(q) at v                                    where the task prescribes a velocity
///   landing and clearance of contacts (PlacementRows)
class CentroidalNode {
 public:
  /// `landing`: see PlacementRows; `ties`: per node of the phase, true if r' is tied to v there.
  /// `discrete` must outlive this.
  CentroidalNode(const DiscreteProblem& discrete, int phase, std::vector<LandingAxes> landing,
                 CentroidalContacts contacts, std::vector<bool> ties);

  const CentroidalColumns& columns(int k) const { return k == 0 ? first_columns_ : columns_; }
  const CentroidalContacts& contacts() const { return held_; }
  const std::vector<std::string>& contact_names() const { return contact_names_; }
  int num_rows(int k) const { return first_row(k, kinds); }
  double lower(int k, int row) const;
  double upper(int k, int row) const;
  std::string describe_row(int k, int row) const;
  std::vector<RowGroup> row_groups(int k) const;

  Eigen::VectorXd configuration(const CentroidalPoint& point) const;
  void evaluate(const CentroidalPoint& point, CentroidalValues& values);
  /// After evaluate() at the same point.
  void add_derivatives(const CentroidalPoint& point, CentroidalValues& values);
  /// After both: Hessian of cost_factor * cost + multipliers . rows in x and the duration, symmetric.
  void hessian(const CentroidalPoint& point, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::MatrixXd& result);
  /// Sets entries that may be non-zero to true, without the duration.
  void mark_hessian(int k, Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>& marks) const;

 private:
  enum Kind { newton, moment, momentum, com, positions, distance, friction, unloaded, com_velocity, placement, kinds };
  int first_row(int k, int kind) const { return first_rows_[k][kind]; }
  int count(int k, int kind) const { return first_row(k, kind + 1) - first_row(k, kind); }
  bool unloads(int k, int contact) const { return k == intervals_ && opens_[contact]; }
  const std::vector<HeldDirection>& directions(int k) const { return k == 0 ? held_.landing : held_.distance; }
  int num_contacts() const { return static_cast<int>(contact_names_.size()); }
  int count_rows(int k, Kind kind) const;

  void set_cost_point(const CentroidalPoint& point);
  void add_dynamics(const CentroidalPoint& point, SparseEntries& jacobian) const;
  void add_kinematics(const CentroidalPoint& point, const Eigen::Matrix3d& Jr, SparseEntries& jacobian);
  void add_limits(const CentroidalPoint& point, const Eigen::Matrix3d& Jr, SparseEntries& jacobian);
  /// Adds 3 rows of derivatives in the tangent of q, converted to theta.
  void add_q(int row, const Eigen::Ref<const Eigen::MatrixXd>& dq, const Eigen::Matrix3d& Jr, double scale,
             SparseEntries& jacobian);

  int nv_, nu_, intervals_;
  CentroidalScale scale_;
  double mass_;
  CentroidalColumns first_columns_, columns_;
  std::vector<int> contact_indices_;
  std::vector<std::string> contact_names_;
  std::vector<bool> opens_, ties_;
  CentroidalContacts held_;
  std::vector<FrictionLimit> friction_;
  PlacementRows placement_;
  NodeCost cost_;
  CentroidalKinematics kinematics_;
  RigidBodyTerms terms_;
  ContactKinematics points_;
  std::vector<std::array<int, kinds + 1>> first_rows_;
  Eigen::VectorXd tau_ref_;
  bool positions_cost_;  ///< positions of contacts have a cost
  // Of the last evaluate() and add_derivatives().
  NodePoint cost_point_;
  Eigen::VectorXd forces_;
  NodeCost::Derivatives cost_slope_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> rotation_;  ///< derivatives of the rows in the tangent of the rotation
  Eigen::Vector3d rotation_gradient_;                  ///< of the cost, likewise
  Eigen::MatrixXd placement_dq_, placement_dv_, placement_dc_;
};

}  // namespace prowl
