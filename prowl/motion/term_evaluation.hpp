#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "prowl/dynamics/centroidal_kinematics.hpp"
#include "prowl/dynamics/point_kinematics.hpp"
#include "prowl/motion/term_use.hpp"

namespace prowl {

/// What terms read at one node of a motion.
struct NodeReading {
  const RigidBodyTerms& kinematics;  ///< at the configuration q
  const Eigen::VectorXd &q, &v, &tau;
  const Eigen::VectorXd& forces;  ///< 3 per contact that the evaluation was made for, world frame [N]
  double time;                    ///< since the start of the motion [s]
};

/// A term at one node: value and derivatives in the variables x = (tangent of q | v | a | tau | others) of the node, by
/// the chain rule:
///
///   df = f_y Y,   d²(lambda . f) = Yᵀ (lambda . f_yy) Y + (lambda . f_y) . Y',   Y = dy / dx
///
/// One object holds the work space of one thread; results stay until the next evaluation.
class TermEvaluation {
 public:
  /// `contacts`: those whose forces are known, as indices of the robot's; others are open.
  TermEvaluation(const RobotModel& robot, const TermUse& use, const std::vector<int>& contacts);

  /// Throws NumericalError, with the name of the use, if f is not finite.
  void evaluate(const NodeReading& at);
  const Eigen::VectorXd& reading() const { return y_; }
  const Eigen::VectorXd& value() const { return value_; }

  /// After evaluate(). `forces_dx`: derivative of the forces in all variables of the node. Throws likewise.
  void differentiate(const Eigen::MatrixXd& forces_dx);
  /// In the variables of the node from first_variable() on: those that the term depends on.
  const Eigen::MatrixXd& dx() const { return dx_; }
  Eigen::Index first_variable() const { return first_; }

  /// After differentiate(): adds the second derivatives of multipliers . f, with forces as linear in the variables.
  void add_hessian(const Eigen::VectorXd& multipliers, Eigen::Ref<Eigen::MatrixXd> hessian);
  /// Adds the derivative of multipliers . f in the forces. It multiplies their second derivatives.
  void add_force_pull(const Eigen::VectorXd& multipliers, Eigen::VectorXd& pull);

 private:
  /// The part of Y for one quantity, in the variables on which it depends: base and joints before its body.
  struct Block {
    Quantity::Kind kind;
    Eigen::Index entry, size;             ///< rows of Y
    std::vector<BodyPoint> points;        ///< of a frame, three rows each
    Eigen::Index point_row;               ///< of its first point in kinematics_
    Eigen::Index force_row;               ///< of a force; -1 if it is not known
    std::vector<Eigen::Index> variables;  ///< columns of `slopes`; set by lay_out()
    Eigen::MatrixXd slopes;               ///< size x number of variables; empty if it is the identity
    bool is_identity() const { return is_of_joints(kind); }
  };

  Block block_of(const RobotModel& robot, const Quantity& quantity, const std::vector<int>& contacts) const;
  /// Sets the variables of all blocks. `num_variables`: of the node.
  void lay_out(const RigidBodyTerms& kinematics, Eigen::Index num_variables);
  void read_entries(const NodeReading& at, const Block& block);
  void read_slopes(const Eigen::MatrixXd& forces_dx, Block& block) const;
  void read_slopes_of_mass(Block& block) const;
  void add_hessian_of_mass(Eigen::Ref<Eigen::MatrixXd> hessian);
  void add_slopes(const Block& block);
  /// Forgets derivatives in the entries of contacts without force, which are constant: |f| has none there.
  void clear_open_contacts();
  void add_bending(const Block& a, const Block& b, Eigen::Ref<Eigen::MatrixXd> hessian);
  void check_finite(bool is_finite, const char* what) const;

  std::string name_;
  std::shared_ptr<const Term> term_;
  double mass_;  ///< of the robot [kg]
  bool reads_point_rates_ = false;
  std::vector<Block> blocks_;
  std::vector<std::vector<int>> chains_;  ///< of the points in kinematics_
  Eigen::Index first_ = 0, last_ = 0;     ///< variables: the first, and the one after the last
  Eigen::Index num_variables_ = 0;        ///< for which the blocks are laid out
  PointKinematics kinematics_;
  std::optional<CentroidalKinematics> of_mass_;  ///< if the term reads such a quantity
  // Work space.
  Eigen::VectorXd at_rest_, y_, value_, pull_, on_position_, on_rate_;
  Eigen::MatrixXd rate_dq_, f_y_, f_yy_, bent_, product_, dx_, mixed_;
};

}  // namespace prowl
