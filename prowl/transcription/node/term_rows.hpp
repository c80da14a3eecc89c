#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/motion/term_evaluation.hpp"
#include "prowl/transcription/node/motion_limit.hpp"

namespace prowl {

/// Limits of the user's terms in one phase, at its nodes k = 0 ... intervals. Each row is divided by natural_size().
///
/// Terms of q and v have no rows at a start that is fixed, and of the two nodes of a phase transition only at the
/// earlier, as q and v are the same at both.
class TermRows {
 public:
  TermRows(const DiscreteProblem& discrete, int phase);

  int most_rows() const;  ///< largest over all nodes
  int count(int k) const { return static_cast<int>(rows_[k].size()); }
  double lower(int k, int row) const { return at(k, row).lower; }
  double upper(int k, int row) const { return at(k, row).upper; }
  std::string describe(int k, int row) const;
  MotionLimit limit(int k, int row) const;  ///< its kind, subject, unit, si and size

  void evaluate(int k, const NodeReading& at_node, Eigen::Ref<Eigen::VectorXd> values);
  /// After evaluate(): derivatives in all variables of the node, whose entries are zero before. `forces_dx`: those of
  /// the forces.
  void derivatives(int k, const Eigen::MatrixXd& forces_dx, Eigen::Ref<Eigen::MatrixXd> dx);
  /// After derivatives(): adds the second derivatives of multipliers . rows at straight forces.
  void add_hessian(int k, const Eigen::Ref<const Eigen::VectorXd>& multipliers, Eigen::Ref<Eigen::MatrixXd> hessian);
  /// Adds the derivative of multipliers . rows in the forces.
  void add_force_pull(int k, const Eigen::Ref<const Eigen::VectorXd>& multipliers, Eigen::VectorXd& pull);

 private:
  struct Row {
    int term, row;        ///< index in terms_; row of that term
    double lower, upper;  ///< scaled
  };
  struct Limit {
    TermUse use;
    TermEvaluation at_node;
    double size;                  ///< natural_size()
    Eigen::VectorXd multipliers;  ///< work space
  };
  const Row& at(int k, int row) const { return rows_[k][row]; }
  /// Rows of one term follow each other: calls each(limit, first row, count) for each term at node k.
  template <class Each>
  void for_each_term(int k, const Each& each);
  /// The same with the multipliers of all rows of the term: calls each(evaluation, multipliers).
  template <class Each>
  void for_each_multiplied(int k, const Eigen::Ref<const Eigen::VectorXd>& multipliers, const Each& each);

  std::vector<Limit> terms_;
  std::vector<std::vector<Row>> rows_;
};

}  // namespace prowl
