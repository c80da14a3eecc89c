#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/nlp/stagewise_nlp.hpp"
#include "prowl/nlp/thread_team.hpp"
#include "prowl/transcription/half_step.hpp"
#include "prowl/transcription/node_program.hpp"

namespace prowl {

/// A NodeProgram as a chain of stages, one a node. docs/transcription.md, "stage by stage":
///
///   states   z, w (half a step before the node's q, v), and what this node and the one before share
///   inputs   a, tau, forces w of dependent contacts, and what is shared from this node on (duration, places)
///
/// Left out is what is fixed: the state of the first node, and inputs with equal bounds. Bounds on q and v are rows at
/// the node; both nodes of a phase switch have the same q and v, so that the first has the rows of both.
///
/// Stage variables are without a unit: lengths are divided by the size l of the robot, forces by its weight m g, times
/// by sqrt(l/g). A solver that regularises adds the same number to the curvature in each. (But w is in newtons.)
class StagewiseTranscription : public StagewiseNlp {
 public:
  /// Of `nodes`, which must outlive it.
  explicit StagewiseTranscription(NodeProgram& nodes);

  int num_stages() const override { return static_cast<int>(stages_.size()); }
  const StageSize& size(int k) const override { return stage(k).size; }
  const Eigen::VectorXd& lower(int k) const override { return stage(k).lower; }
  const Eigen::VectorXd& upper(int k) const override { return stage(k).upper; }

  const StageValues& values(int k, const Eigen::VectorXd& ux) override;
  const StageDerivatives& derivatives(int k, const Eigen::VectorXd& ux) override;
  const Eigen::MatrixXd& hessian(int k, const Eigen::VectorXd& ux, double cost_factor,
                                 const StageMultipliers& multipliers) override;

  void linearise(int k, const Eigen::VectorXd& ux, double cost_factor, const StageMultipliers& multipliers) override;
  void linearise_to_first_order(int k, const Eigen::VectorXd& ux) override;
  const Eigen::VectorXd& cost_gradient(int k) const override { return stage(k).cost_gradient; }
  const Eigen::MatrixXd& equality_slopes(int k) const override { return stage(k).equality_slopes; }
  const Eigen::MatrixXd& lagrangian_hessian(int k) const override { return stage(k).hessian; }
  void condense(int k, const Eigen::MatrixXd& next_hessian, const Eigen::VectorXd& weights,
                Eigen::MatrixXd& result) override;
  void push_forward(int k, const Eigen::VectorXd& step, Eigen::VectorXd& next, Eigen::VectorXd& inequalities) override;
  void add_pull_back(int k, const Eigen::VectorXd& on_next, const Eigen::VectorXd& on_inequalities,
                     Eigen::VectorXd& gradient) override;

  std::vector<Eigen::VectorXd> stages(const Eigen::VectorXd& z) const override;
  Eigen::VectorXd flat(const std::vector<Eigen::VectorXd>& stages) const override;
  std::string describe_stage(int k) const override;

  void use_threads(int count);  ///< see Nlp

 private:
  /// Gradients of the inequalities among the rows of a node, one a column, and where they are not zero.
  struct InequalityRows {
    Eigen::MatrixXd gradients;
    Eigen::MatrixXi places;
    Eigen::VectorXi counts;
  };
  /// Work space, in the variables of a node. Stages of one shape share it, so that it keeps its size; one a thread.
  struct Work {
    NodeValues values;  ///< of the stage evaluated last
    Eigen::VectorXd on_rows, on_node, step, on_next, state;
    Eigen::MatrixXd form, slopes, scaled, dense;
  };
  struct Stage {
    StageSize size;
    std::size_t shape = 0;       ///< its work space
    std::vector<int> variables;  ///< of (u, x): places among the variables of the node, z and w in those of q and v
    struct Run {
      int first, place, length;
    };
    std::vector<Run> runs;     ///< the same, as ranges without a gap
    Eigen::VectorXd unit;      ///< of each of those: variable of the node = unit * variable of the stage
    Eigen::VectorXd fixed;     ///< all variables of the node, with the values of those that are fixed
    std::vector<int> carried;  ///< shared variables that are states of the next stage: places among the node's
    // Functions: (rows of the node, as in NodeFunctions | variables of the node with bounds), the last in their units.
    int num_rows = 0;
    std::vector<int> bounded;  ///< variables
    Eigen::VectorXd per_unit,
        next_per_unit;  ///< 1 / unit of the variables with bounds and of the states of the next stage
    std::vector<int> equalities, inequalities;  ///< places among the functions
    Eigen::VectorXd level;                      ///< equalities: function = level
    Eigen::VectorXd lower, upper;

    // What was evaluated last, and where.
    Eigen::VectorXd at;
    bool have_values = false, have_derivatives = false;
    Arrival arrival;
    Departure departure;
    NodePoint point;
    StageValues values;
    Eigen::VectorXd cost_gradient;
    Eigen::MatrixXd equality_slopes, hessian;
    InequalityRows rows;
    Arrival linear_arrival;  ///< where the stage was linearised, which values elsewhere must not change
    Departure linear_departure;

    StageDerivatives derivatives;  ///< dense, if asked for
    const Eigen::VectorXd& node() const { return arrival.node(); }
    int num_next() const { return static_cast<int>(next_per_unit.size()); }
    /// Of an inequality that is a bound: its variable, and the bound's slope in that.
    std::pair<int, double> bound(Eigen::Index inequality) const {
      const int i = inequalities[inequality] - num_rows;
      return {bounded[i], per_unit(i)};
    }
  };
  const Stage& stage(int k) const { return stages_[k]; }

  Stage& stage(int k) { return stages_[k]; }
  Work& work(const Stage& stage) { return works_[ThreadTeam::slot()][stage.shape]; }

  /// Units of all variables of node k.
  Eigen::VectorXd units(int k) const;
  void set_variables(int k);
  void set_functions(int k);
  void set_shapes();
  /// Bounds on a variable of node k. Both nodes of a phase switch have one q and v: the first has the bounds of both.
  std::pair<double, double> bounds(int k, int variable) const;

  /// Half of interval i of the phase of node k, which is on one side of it; there is none at the ends of the phase.
  HalfTime half_time(int k, int i, const Eigen::VectorXd& node) const;
  void set_arrival(int k, const Eigen::VectorXd& ux, Eigen::VectorXd& state, Arrival& arrival) const;
  /// Sets the point; what was evaluated elsewhere is forgotten.
  void move_to(int k, const Eigen::VectorXd& ux);
  void fill_values(int k, const NodeValues& node);
  void fill_slopes(int k, const NodeValues& node);
  void keep_linear(Stage& stage);
  /// Multipliers, or a gradient, of the next states in the places that these have among the node's variables.
  void add_on_next(const Stage& stage, const Eigen::VectorXd& on_next, Eigen::VectorXd& on_node) const;
  static void gather(const Stage& stage, const Eigen::MatrixXd& form, Eigen::MatrixXd& result);

  NodeProgram& nodes_;
  const DiscreteProblem& discrete_;
  const DecisionLayout& layout_;
  std::vector<Stage> stages_;
  std::vector<std::vector<Work>> works_;  ///< for each thread, one a shape
};

}  // namespace prowl
