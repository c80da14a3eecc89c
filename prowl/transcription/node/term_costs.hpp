#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/motion/term_evaluation.hpp"
#include "prowl/transcription/node/node_point.hpp"

namespace prowl {

/// Costs of the user's terms in one phase, at its nodes: 1/2 (f - reference)ᵀ W (f - reference) times the part of the
/// node's quadrature weight inside the span of the term, or once at the term's moment.
class TermCosts {
 public:
  TermCosts(const DiscreteProblem& discrete, int phase);

  struct Value {
    double running = 0.0;    ///< proportional to the duration of the phase
    double at_moment = 0.0;  ///< not so
  };
  /// `at_node`: at the point.
  Value value(const NodePoint& point, const NodeReading& at_node);
  /// After value(): adds the gradient in all variables of the node, of all costs and of the running ones alone.
  /// `forces_dx`: derivative of the forces in these variables.
  void add_gradient(const NodePoint& point, const Eigen::MatrixXd& forces_dx, Eigen::VectorXd& gradient,
                    Eigen::VectorXd& running);
  /// After add_gradient(): adds factor times the Hessian at straight forces.
  void add_hessian(const NodePoint& point, double factor, Eigen::MatrixXd& result);
  /// After add_gradient(): adds factor times the derivative of the cost in the forces.
  void add_force_pull(const NodePoint& point, double factor, Eigen::VectorXd& pull);

 private:
  struct Cost {
    TermEvaluation at_node;
    Eigen::MatrixXd weight;
    Eigen::VectorXd reference;
    bool is_moment;
    std::vector<double> shares;          ///< of the quadrature weight of each node; of 1 for a moment
    Eigen::VectorXd pull;                ///< W (f - reference), of the last value()
    Eigen::VectorXd error = {};          ///< work space
    Eigen::MatrixXd weighted = {};       ///< likewise
    Eigen::VectorXd weighted_pull = {};  ///< likewise
  };
  static double weight_at(const Cost& cost, const NodePoint& point);

  std::vector<Cost> costs_;
};

}  // namespace prowl
