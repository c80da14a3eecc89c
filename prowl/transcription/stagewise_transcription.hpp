#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/nlp/stagewise_nlp.hpp"
#include "prowl/transcription/half_step.hpp"
#include "prowl/transcription/node_functions.hpp"

namespace prowl {

class Transcription;

/// A Transcription as a chain of stages, one a node. docs/transcription.md, "stage by stage":
///
///   states   z, w (half a step before the node's q, v), and what this node and the one before share
///   inputs   a, tau, forces w of dependent contacts, and what is shared from this node on (duration, places)
///
/// Left out is what is fixed: the state of the first node, and inputs with equal bounds. Bounds on q and v are rows at the
/// node; both nodes of a phase switch have the same q and v, so that the first has the rows of both.
///
/// Stage variables are without a unit: lengths are divided by the size l of the robot, forces by its weight m g, times by
/// sqrt(l/g). A solver that regularises adds the same number to the curvature in each. (But w is in newtons.)
class StagewiseTranscription : public DenseStagewiseNlp {
 public:
  /// A view of `flat`, which must outlive it and not move.
  explicit StagewiseTranscription(Transcription& flat);

  int num_stages() const override { return static_cast<int>(stages_.size()); }
  const StageSize& size(int k) const override { return stage(k).size; }
  const Eigen::VectorXd& lower(int k) const override { return stage(k).lower; }
  const Eigen::VectorXd& upper(int k) const override { return stage(k).upper; }

  const StageValues& values(int k, const Eigen::VectorXd& ux) override;
  const StageDerivatives& derivatives(int k, const Eigen::VectorXd& ux) override;
  const Eigen::MatrixXd& hessian(int k, const Eigen::VectorXd& ux, double cost_factor,
                                 const StageMultipliers& multipliers) override;

  std::vector<Eigen::VectorXd> stages(const Eigen::VectorXd& z) const override;
  Eigen::VectorXd flat(const std::vector<Eigen::VectorXd>& stages) const override;
  std::string describe_stage(int k) const override;

 private:
  struct Stage {
    StageSize size;
    std::vector<int> variables;  ///< of (u, x): places among the variables of the node, z and w in those of q and v
    Eigen::VectorXd unit;        ///< of each of those: variable of the node = unit * variable of the stage
    Eigen::VectorXd fixed;       ///< all variables of the node, with the values of those that are fixed
    std::vector<int> carried;    ///< shared variables that are states of the next stage: places among the node's
    // Functions: (rows of the node, as in NodeFunctions | variables of the node with bounds | states of the next stage),
    // the last two in their units.
    int num_functions = 0;
    std::vector<int> bounded;                   ///< variables
    Eigen::VectorXd per_unit, next_per_unit;    ///< 1 / unit of the variables with bounds and of the states of the next stage
    std::vector<int> equalities, inequalities;  ///< places among the functions
    Eigen::VectorXd level;                      ///< equalities: function = level
    Eigen::VectorXd lower, upper;

    // What was evaluated last, and where.
    Eigen::VectorXd at, node;
    bool have_values = false, have_derivatives = false;
    NodePoint point;
    NodeValues node_values;
    StageValues values;
    StageDerivatives derivatives;
    Eigen::MatrixXd slopes;  ///< of the functions in the variables of the node
    Eigen::MatrixXd hessian;

    /// Derivatives in the variables of the node, in those of the stage.
    template <class Matrix>
    Eigen::MatrixXd of_stage(const Matrix& slopes) const {
      return slopes(Eigen::all, variables) * unit.asDiagonal();
    }
    int first_next() const { return num_functions - static_cast<int>(values.next.size()); }
  };
  const Stage& stage(int k) const { return stages_[static_cast<std::size_t>(k)]; }

  Stage& stage(int k) { return stages_[static_cast<std::size_t>(k)]; }

  /// Units of all variables of node k.
  Eigen::VectorXd units(int k) const;
  void set_variables(int k);
  void set_functions(int k);
  /// Bounds on a variable of node k. Both nodes of a phase switch have one q and v: the first has the bounds of both.
  std::pair<double, double> bounds(int k, int variable) const;

  /// Half the step `h` of the mesh on one side of node k.
  HalfTime half_time(int k, double h, const Eigen::VectorXd& node) const;
  Arrival arrival(int k, const Eigen::VectorXd& ux) const;
  Departure departure(int k) const;
  /// Sets the point; what was evaluated elsewhere is forgotten.
  void move_to(int k, const Eigen::VectorXd& ux);
  void evaluate(int k, bool with_derivatives);

  Transcription& flat_;
  std::vector<Stage> stages_;
  Eigen::VectorXd scratch_;  ///< decision variables of the flat form, as far as the stage in hand needs them
};

}  // namespace prowl
