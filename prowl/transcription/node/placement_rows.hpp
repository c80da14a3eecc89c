#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// Surface axes (0 and 1 tangential, 2 normal) along which a contact is positioned and stopped at
/// the first node of a phase. Of a landing contact all three, unless other contacts determine some
/// of them; likewise of a contact that stands from a start that the optimiser chooses.
struct LandingAxes {
  std::vector<int> foothold;
  std::vector<int> velocity;
};

/// Fraction of the clearance at progress s in [0, 1] of a swing that lands: 1 in the middle. A contact leaves and lands
/// at rest, so its height starts and ends quadratically in time.
constexpr double swing_profile(double s) { return 16.0 * s * s * (1.0 - s) * (1.0 - s); }

/// Constraints of one phase on contact positions, at its node k = 0 ... intervals:
/// - A contact that lands at the first node, or stands there at a free start, is at its anchor and at rest:
///     axis . (p - anchor) = 0,  axis . J v = 0,
///   and an anchor that is chosen is inside the patch:  inward . (anchor - corner) >= 0 for each edge.
/// - A contact in the air keeps its clearance of the surfaces that it passes:
///     normal . (p - point) - radius >= height(k).
/// Lengths are divided by the size l of the robot, velocities by sqrt(g l).
class PlacementRows {
 public:
  /// `landing`: per contact of the phase. `intervals_at_rest`: number of
  /// intervals before landing in which the contact is already down. Backward Euler needs one: its
  /// velocity at a node is that of the interval before.
  PlacementRows(const DiscreteProblem& discrete, int phase, const std::vector<LandingAxes>& landing,
                int intervals_at_rest = 0);

  /// Instead, at each node, four rows for every contact of the robot: its height above the first surface,
  /// normal . (p - point) - radius, and its velocity along the surface's axes and normal. The caller sets their bounds.
  static PlacementRows motion_of_contacts(const DiscreteProblem& discrete, int phase);

  int most_rows() const;  ///< largest over all nodes
  int count(int k) const { return static_cast<int>(rows_[k].size()); }
  double lower(int k, int row) const { return at(k, row).lower; }
  double upper(int k, int row) const;
  std::string describe(int k, int row) const;
  enum class Kind { foothold, velocity, inside, clearance };
  Kind kind(int k, int row) const { return at(k, row).kind; }
  int contact(int k, int row) const { return points_[at(k, row).point]; }  ///< of the robot

  /// Values at the configuration of `terms` and velocity v. `anchors`: of the phase's contacts, 3
  /// each, world frame [m].
  void evaluate(int k, const RigidBodyTerms& terms, const Eigen::VectorXd& v, const Eigen::VectorXd& anchors,
                Eigen::Ref<Eigen::VectorXd> values);
  /// After evaluate(): derivatives in the tangent of q, in v and in the anchors; overwrites all
  /// entries.
  void derivatives(int k, Eigen::Ref<Eigen::MatrixXd> dq, Eigen::Ref<Eigen::MatrixXd> dv,
                   Eigen::Ref<Eigen::MatrixXd> danchors);
  /// After derivatives() or evaluate(): adds the second derivatives of multipliers . rows; vq:
  /// mixed block, one row per velocity.
  void add_hessian(int k, const Eigen::Ref<const Eigen::VectorXd>& multipliers, Eigen::Ref<Eigen::MatrixXd> qq,
                   Eigen::Ref<Eigen::MatrixXd> vq);

 private:
  PlacementRows(const DiscreteProblem& discrete, int phase);
  struct Row {
    Kind kind;
    int point;             ///< index of the contact among the points of kinematics_
    int held;              ///< index among the contacts of the phase, if it lands
    Eigen::Vector3d axis;  ///< world
    double offset;         ///< clearance: normal . point + radius; inside: inward . corner
    double lower, scale;
    std::string what;
  };
  const Row& at(int k, int row) const { return rows_[k][row]; }
  void add_landing(const DiscreteProblem& discrete, int phase, const std::vector<LandingAxes>& landing);
  void add_clearance(const DiscreteProblem& discrete, int phase, const ContactSwing& swing, int intervals_at_rest);
  int point_of(int contact);

  double length_, speed_;
  std::vector<int> points_;
  std::vector<std::vector<Row>> rows_;
  ContactKinematics kinematics_;
  Eigen::MatrixXd velocity_dq_;
  Eigen::VectorXd v_, at_rest_;                ///< of the last evaluate(); zeros
  Eigen::VectorXd on_position_, on_velocity_;  ///< multipliers, per row of kinematics_
  SecondDerivatives second_;
};

}  // namespace prowl
