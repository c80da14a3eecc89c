#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prowl/mpc/mpc_weights.hpp"
#include "prowl/nlp/stagewise_nlp.hpp"
#include "prowl/transcription/half_step.hpp"
#include "prowl/transcription/node/node_functions.hpp"
#include "prowl/transcription/stage_slopes.hpp"

namespace prowl {

/// What one step of the horizon is about, set before each linearisation.
struct HorizonStep {
  double length = 0.0;           ///< h [s]
  unsigned standing = 0;         ///< bit f: foot f stands
  double contact_time = 0.0;     ///< time constant with which velocities of standing contacts decay [s]
  Eigen::VectorXd q_ref, v_ref;  ///< nq, nv
};

/// The motion problem of a horizon as a chain of stages, one per step, with the functions and derivatives of the
/// planner (NodeFunctions) in the middle of each step:
///
///   states   (q, v) at the start of the step
///   inputs   a, tau, forces of dependent contacts: constant over the step
///   v_mid = v + h/2 a,  q_mid = q (+) h/2 v_mid,   c(q_mid, v_mid, a, tau) = 0,   v' = v_mid + h/2 a,
///   q' = q_mid (+) h/2 v_mid
///
/// This midpoint rule is of second order and has the half steps (Arrival, Departure) of the planner's trapezoid. A step
/// has one set of contacts and one torque: a phase transition needs no second node, and the first torque acts. Contacts
/// of feet that stand are held in velocity only: their anchors are where the feet are.
///
/// Inequalities of a stage: friction pyramid of each contact of the robot | torque curves | height above the ground and
/// velocity of each contact | joint positions | joint velocities | torques. Unused rows, such as friction of a foot
/// in the air, are constant. All stages have equal sizes, so that nothing is allocated after construction.
///
/// Variables are dimensionless as those of StagewiseTranscription.
class HorizonProgram : public LinearisedChain {
 public:
  /// Throws InputError if the robot's standing posture does not put its contacts on the ground.
  HorizonProgram(const RobotModel& robot, const MpcWeights& weights, double friction, int steps);
  ~HorizonProgram() override;

  const RobotModel& robot() const { return robot_; }
  const std::vector<std::vector<int>>& feet() const { return feet_; }
  const Eigen::VectorXd& standing_posture() const { return standing_; }  ///< standing_on_ground()
  int num_feet() const { return static_cast<int>(feet_.size()); }
  unsigned num_sets() const { return 1U << feet_.size(); }  ///< of standing feet
  /// Contacts of a set, in the order of RobotModel::contacts(). Bit f: foot f stands.
  const std::vector<int>& contacts(unsigned standing) const { return sets_[standing].contacts; }

  // Rows of the inequalities.
  int friction_row(int contact) const { return FrictionLimit::kMostRows * contact; }  ///< of four
  int height_row(int contact) const { return curve_row() + num_curve_rows_ + 4 * contact; }
  /// Of three: velocity along the ground's axes and normal.
  int contact_velocity_row(int contact) const { return height_row(contact) + 1; }
  int curve_row() const { return friction_row(num_contacts_); }
  int num_curve_rows() const { return num_curve_rows_; }
  int position_row(int joint) const { return num_rows_ + joint; }
  int velocity_row(int joint) const { return num_rows_ + nu_ + joint; }
  int torque_row(int joint) const { return num_rows_ + 2 * nu_ + joint; }
  int num_inequalities() const { return num_rows_ + 3 * nu_; }
  double length_unit() const { return length_; }  ///< of heights and places [m]
  /// Units of the inequalities: a row times its unit is in N, N m, m, rad, ...
  double row_unit(int row) const { return row_units_(row); }
  const Eigen::VectorXd& unit() const { return unit_; }  ///< of the variables (u, x) of a stage

  HorizonStep& step(int k) { return stages_[static_cast<std::size_t>(k)].step; }
  const HorizonStep& step(int k) const { return stages_[static_cast<std::size_t>(k)].step; }
  /// Variables of a stage (u, x). The base rotation of its state is relative to chart(k).
  Eigen::VectorXd& variables(int k) { return stages_[static_cast<std::size_t>(k)].ux; }
  /// Sets state and inputs of a stage, and its chart to the rotation of q.
  void set_stage(int k, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                 const Eigen::VectorXd& tau);
  /// State at the start of step k, at the current variables.
  void get_state(int k, Eigen::VectorXd& q, Eigen::VectorXd& v) const;
  void get_inputs(int k, Eigen::VectorXd& a, Eigen::VectorXd& tau) const;
  /// (q, v) as the states of stage k, in its chart and units.
  void to_states(int k, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& states) const;

  StageMultipliers& multipliers(int k) { return stages_[static_cast<std::size_t>(k)].on; }

  void use_hessian(HessianKind kind);  ///< default: exact. Before the first step, as it moves the first stage
  /// Values and derivatives at the variables, with the Hessian of the Lagrangian. Throws NumericalError.
  void linearise(int k);
  const Eigen::VectorXd& equalities(int k) const { return stages_[static_cast<std::size_t>(k)].equalities; }
  const Eigen::VectorXd& inequalities(int k) const { return stages_[static_cast<std::size_t>(k)].inequalities; }
  /// Continuity error: next state minus the next stage's state.
  const Eigen::VectorXd& link(int k) const { return stages_[static_cast<std::size_t>(k)].link; }
  const Eigen::VectorXd& cost_gradient(int k) const {
    return stages_[static_cast<std::size_t>(k)].slopes.cost_gradient;
  }
  double cost(int k) const { return stages_[static_cast<std::size_t>(k)].cost; }
  /// Forces of the contacts of the robot at the last linearisation, world frame [N]; zero in the air.
  const Eigen::VectorXd& forces(int k) const { return stages_[static_cast<std::size_t>(k)].forces; }

  int num_stages() const override { return static_cast<int>(stages_.size()); }
  const StageSize& size(int) const override { return size_; }
  const Eigen::MatrixXd& equality_slopes(int k) const override { return slopes(k).equalities; }
  const Eigen::MatrixXd& lagrangian_hessian(int k) const override { return slopes(k).hessian; }
  void add_condensed(int k, const Eigen::MatrixXd& next_hessian, const Eigen::VectorXd& weights,
                     Eigen::MatrixXd& result) override {
    condenser_.add(slopes(k), next_hessian, weights, result);
  }
  void push_forward(int k, const Eigen::VectorXd& step, Eigen::VectorXd& next, Eigen::VectorXd& inequalities) override {
    slopes(k).push_forward(step, next, inequalities);
  }
  void add_pull_back(int k, const Eigen::VectorXd& on_next, const Eigen::VectorXd& on_inequalities,
                     Eigen::VectorXd& gradient) override {
    slopes(k).add_pull_back(on_next, on_inequalities, gradient);
  }

 private:
  /// The functions of one set of standing feet.
  struct ContactSet {
    std::unique_ptr<DiscreteProblem> discrete;
    std::unique_ptr<NodeFunctions> functions;
    std::vector<int> contacts;
    std::vector<int> inequalities;  ///< index of each row of the functions after the dynamics
    // Work space of its sizes.
    NodePoint point;
    NodeValues values;
    Eigen::VectorXd on_rows;
    Eigen::MatrixXd form;

    int inequality_of(Eigen::Index row, int dynamics) const {
      return inequalities[static_cast<std::size_t>(row - dynamics)];
    }
    int num_chosen() const { return static_cast<int>(functions->chosen_rows().size()); }
  };
  struct Stage {
    HorizonStep step;
    Eigen::Matrix3d chart;
    Eigen::VectorXd ux;
    StageMultipliers on;
    Arrival arrival;
    Departure departure;
    double cost = 0.0;
    Eigen::VectorXd equalities, inequalities, link, forces;
    StageSlopes slopes;
  };
  const StageSlopes& slopes(int k) const { return stages_[static_cast<std::size_t>(k)].slopes; }
  void size_work_spaces();
  void make_sets(const MpcWeights& weights, double friction, double heading);
  ContactSet& set_of(const Stage& stage);
  void set_patterns(Stage& stage, bool is_last);
  void set_point(Stage& stage, ContactSet& set);
  void fill_values(int k, const ContactSet& set);
  void fill_slopes(int k, const ContactSet& set);
  int find_inequality(const ContactSet& set, int row) const;

  RobotModel robot_;
  int nv_, nu_, num_contacts_, num_curve_rows_ = 0, num_rows_ = 0, num_chosen_ = 0;
  double length_;
  std::vector<std::vector<int>> feet_;
  Eigen::VectorXd standing_;
  std::vector<ContactSet> sets_;  ///< by the bits of standing feet; of flat feet, then the same for another heading
  StageSize size_;
  Eigen::VectorXd unit_, row_units_;
  std::vector<Stage> stages_;
  StageCondenser condenser_;
  // Work space.
  Eigen::VectorXd node_, no_correction_, on_node_, on_next_, next_;
  Eigen::MatrixXd form_, slopes_;
};

}  // namespace prowl
