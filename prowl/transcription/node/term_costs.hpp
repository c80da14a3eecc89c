#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/motion/term_evaluation.hpp"
#include "prowl/transcription/node/node_point.hpp"

namespace prowl {

/// Costs of the user's terms in one phase, at its nodes: 1/2 sum_i weight_i (f_i - reference_i)^2 times the part of the
/// node's quadrature weight inside the span of the term, or once at the term's moment.
class TermCosts {
 public:
  TermCosts(const DiscreteProblem& discrete, int phase);

  bool empty() const { return costs_.empty(); }
  struct Value {
    double running = 0.0;    ///< proportional to the duration of the phase
    double at_moment = 0.0;  ///< not so
  };
  /// `kinematics`: at the configuration of the point.
  Value value(const NodePoint& point, const RigidBodyTerms& kinematics);
  /// After value(): adds the gradient in (tangent of q | v | ...) of all costs, and of the running ones alone.
  void add_gradient(const NodePoint& point, Eigen::VectorXd& gradient, Eigen::VectorXd& running);
  /// After add_gradient(): adds factor times the Hessian to the first 2 nv rows and columns, its lower triangle.
  void add_hessian(const NodePoint& point, double factor, Eigen::MatrixXd& result);

 private:
  struct Cost {
    TermEvaluation at_node;
    Eigen::VectorXd weight, reference;
    bool is_moment;
    std::vector<double> shares;          ///< of the quadrature weight of each node; of 1 for a moment
    Eigen::VectorXd pull;                ///< weight (f - reference), of the last value()
    Eigen::MatrixXd weighted = {};       ///< work space
    Eigen::VectorXd weighted_pull = {};  ///< likewise
  };
  static double weight_at(const Cost& cost, const NodePoint& point);

  std::vector<Cost> costs_;
};

}  // namespace prowl
