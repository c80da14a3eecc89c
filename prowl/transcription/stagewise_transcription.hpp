#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/nlp/stagewise_nlp.hpp"
#include "prowl/nlp/thread_team.hpp"
#include "prowl/transcription/half_step.hpp"
#include "prowl/transcription/node_program.hpp"
#include "prowl/transcription/stage_slopes.hpp"

namespace prowl {

/// A NodeProgram as a chain of stages, one per node. docs/transcription.md, "Stage by stage":
///
///   states   z, w (half a step before the node's q, v), variables shared with the node before
///   inputs   a, tau, forces w of dependent contacts, variables shared from this node on (duration,
///            footholds)
///
/// Fixed variables are left out: of the state of the first node, and inputs, those with equal bounds.
/// What the start leaves free is an input of the first stage. Bounds
/// on q and v are rows of the node; the two nodes of a phase transition have the same q and v, so
/// the first has the rows of both.
///
/// Stage variables are dimensionless, as a regularising solver adds the same curvature to each:
/// lengths are divided by the size l of the robot, forces by its weight m g, times by sqrt(l/g).
/// (But w is in newtons.)
class StagewiseTranscription : public StagewiseNlp {
 public:
  /// `nodes` must outlive it.
  explicit StagewiseTranscription(NodeProgram& nodes);

  int num_stages() const override { return static_cast<int>(stages_.size()); }
  const StageSize& size(int k) const override { return stage(k).size; }
  const Eigen::VectorXd& lower(int k) const override { return stage(k).lower; }
  const Eigen::VectorXd& upper(int k) const override { return stage(k).upper; }
  const Eigen::MatrixXd& closure() const override { return closure_; }

  const StageValues& values(int k, const Eigen::VectorXd& ux) override;
  const StageDerivatives& derivatives(int k, const Eigen::VectorXd& ux) override;
  const Eigen::MatrixXd& hessian(int k, const Eigen::VectorXd& ux, double cost_factor,
                                 const StageMultipliers& multipliers) override;

  void linearise(int k, const Eigen::VectorXd& ux, double cost_factor, const StageMultipliers& multipliers) override;
  void linearise_to_first_order(int k, const Eigen::VectorXd& ux) override;
  const Eigen::VectorXd& cost_gradient(int k) const override { return stage(k).slopes.cost_gradient; }
  const Eigen::MatrixXd& equality_slopes(int k) const override { return stage(k).slopes.equalities; }
  const Eigen::MatrixXd& lagrangian_hessian(int k) const override { return stage(k).slopes.hessian; }
  void add_condensed(int k, const Eigen::MatrixXd& next_hessian, const Eigen::VectorXd& weights,
                     Eigen::MatrixXd& result) override;
  void push_forward(int k, const Eigen::VectorXd& step, Eigen::VectorXd& next, Eigen::VectorXd& inequalities) override;
  void add_pull_back(int k, const Eigen::VectorXd& on_next, const Eigen::VectorXd& on_inequalities,
                     Eigen::VectorXd& gradient) override;

  std::vector<Eigen::VectorXd> stages(const Eigen::VectorXd& z) const override;
  Eigen::VectorXd flat(const std::vector<Eigen::VectorXd>& stages) const override;
  std::string describe_stage(int k) const override;

  void use_threads(int count);  ///< see Nlp

 private:
  /// Of Work::slopes, the last rows: placement of the base, and of the next stage's.
  static constexpr int kBaseRows = 12;

  /// Work space in the variables of a node, one per thread. Stages of one shape share it: no
  /// reallocation.
  struct Work {
    NodeValues values;  ///< of the stage evaluated last
    Eigen::VectorXd on_rows, on_node, on_next, state;
    Eigen::MatrixXd form;
    StageCondenser condenser;
    /// (rows of the node | placement of the base | that of the next stage) in the node's variables, then in the
    /// state's.
    Eigen::MatrixXd slopes;
  };
  struct Stage {
    StageSize size;
    std::size_t shape = 0;       ///< index of its work space
    std::vector<int> variables;  ///< of (u, x): indices into the variables of the node; z, w: those of q, v
    struct Run {
      int first, variable, length;
    };
    std::vector<Run> runs;     ///< the same as contiguous ranges
    Eigen::VectorXd unit;      ///< variable of the node = unit * variable of the stage
    Eigen::VectorXd fixed;     ///< all variables of the node; fixed ones have their values
    std::vector<int> carried;  ///< shared variables that are states of the next stage: indices into the node's
    // Functions: (rows of the node, as in NodeFunctions | variables of the node with bounds), the last in their units.
    int num_rows = 0;
    std::vector<int> bounded;  ///< variables
    Eigen::VectorXd per_unit,
        next_per_unit;  ///< 1 / unit of the variables with bounds and of the states of the next stage
    std::vector<int> equalities, inequalities;  ///< indices into the functions
    int num_first_equalities = 0;               ///< so many of them are the first rows, in order: at least the dynamics
    Eigen::VectorXd level;                      ///< equalities: function = level
    Eigen::VectorXd lower, upper;

    // Last evaluation and its point.
    Eigen::VectorXd at;
    bool have_values = false, have_derivatives = false;
    Arrival arrival;
    Departure departure;
    NodePoint point;
    StageValues values;

    StageSlopes slopes;            ///< of the last linearisation, kept during evaluations elsewhere
    StageDerivatives derivatives;  ///< the same as dense matrices, on request
    const Eigen::VectorXd& node() const { return arrival.node(); }
    int num_next() const { return static_cast<int>(next_per_unit.size()); }
  };
  const Stage& stage(int k) const { return stages_[k]; }

  Stage& stage(int k) { return stages_[k]; }
  Work& work(const Stage& stage) { return works_[ThreadTeam::slot()][stage.shape]; }

  /// Units of all variables of node k.
  Eigen::VectorXd units(int k) const;
  void set_variables(int k);
  void set_functions(int k);
  void set_shapes();
  void set_closure();
  /// Bounds on a variable of node k. At a phase transition the first node has the bounds of both.
  std::pair<double, double> bounds(int k, int variable) const;

  /// Half of interval i of the phase of node k, an interval beside the node; zero beyond the ends
  /// of the phase.
  HalfTime half_time(int k, int i, const Eigen::VectorXd& node) const;
  void set_arrival(int k, const Eigen::VectorXd& ux, Eigen::VectorXd& state, Arrival& arrival) const;
  /// Sets the point; discards evaluations elsewhere.
  void move_to(int k, const Eigen::VectorXd& ux);
  void fill_values(int k, const NodeValues& node);
  void fill_slopes(int k, const NodeValues& node);
  void set_patterns(int k);
  /// Derivatives of bound i or of next state i in a variable of the state, without units, from those of the base in the
  /// last rows of `slopes`.
  double bound_slope(int k, const Eigen::MatrixXd& slopes, int i, int variable) const;
  double next_slope(int k, const Eigen::MatrixXd& slopes, int i, int variable) const;
  /// Entry of a row for the joint, or degree of freedom, `dof`.
  double entry(int k, const Arrival::JointRow& row, int dof, int variable) const;
  void fill_base_slopes(Stage& stage, Eigen::MatrixXd& slopes) const;
  /// Adds multipliers or a gradient of the next states at their positions among the node's
  /// variables.
  void add_on_next(const Stage& stage, const Eigen::VectorXd& on_next, Eigen::VectorXd& on_node) const;
  /// The lower triangle, in the variables of the stage.
  static void gather(const Stage& stage, const Eigen::MatrixXd& form, Eigen::MatrixXd& result);

  NodeProgram& nodes_;
  const DiscreteProblem& discrete_;
  const DecisionLayout& layout_;
  std::vector<Stage> stages_;
  Eigen::MatrixXd closure_;               ///< of a cycle
  std::vector<std::vector<Work>> works_;  ///< per thread and shape
};

}  // namespace prowl
