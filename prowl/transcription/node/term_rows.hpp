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
/// A start that is fixed has no rows, and of the two nodes of a phase transition only the earlier has: q and v are
/// the same at both.
class TermRows {
 public:
  TermRows(const DiscreteProblem& discrete, int phase);

  int most_rows() const;  ///< largest over all nodes
  int count(int k) const { return static_cast<int>(rows_[k].size()); }
  double lower(int k, int row) const { return at(k, row).lower; }
  double upper(int k, int row) const { return at(k, row).upper; }
  std::string describe(int k, int row) const;
  MotionLimit limit(int k, int row) const;  ///< its kind, subject, unit, si and size

  /// `kinematics`: at the configuration q.
  void evaluate(int k, const RigidBodyTerms& kinematics, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                Eigen::Ref<Eigen::VectorXd> values);
  /// After evaluate(): derivatives in the tangent of q and in v; overwrites all entries.
  void derivatives(int k, Eigen::Ref<Eigen::MatrixXd> dq, Eigen::Ref<Eigen::MatrixXd> dv);
  /// After derivatives(): adds the second derivatives of multipliers . rows; vq has one row for each velocity.
  void add_hessian(int k, const Eigen::Ref<const Eigen::VectorXd>& multipliers, Eigen::Ref<Eigen::MatrixXd> qq,
                   Eigen::Ref<Eigen::MatrixXd> vq, Eigen::Ref<Eigen::MatrixXd> vv);

 private:
  struct Row {
    int term, row;        ///< index in terms_; row of that term
    double lower, upper;  ///< scaled
  };
  struct Limit {
    TermEvaluation at_node;
    std::string name;
    bool is_moment;
    std::string unit;
    std::vector<std::string> rows;
    double size;                  ///< natural_size()
    Eigen::VectorXd multipliers;  ///< work space
  };
  const Row& at(int k, int row) const { return rows_[k][row]; }
  /// Rows of one term follow each other: calls each(limit, first row, count) for each term at node k.
  template <class Each>
  void for_each_term(int k, const Each& each);

  std::vector<Limit> terms_;
  std::vector<std::vector<Row>> rows_;
};

}  // namespace prowl
