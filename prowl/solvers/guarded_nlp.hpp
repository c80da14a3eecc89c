#pragma once

#include <Eigen/Core>
#include <string>

#include "prowl/nlp/nlp.hpp"
#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// An Nlp for C and C++ solver libraries: catches exceptions, reports NaN and infinity in the words
/// of the task, and measures time. Every function returns false if its result must not be used.
class GuardedNlp {
 public:
  explicit GuardedNlp(Nlp& nlp) : nlp_(nlp) {}

  const Nlp& nlp() const { return nlp_; }

  bool cost(const Eigen::VectorXd& z, double& value);
  bool cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient);
  bool constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g);
  bool jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values);
  bool hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values);
  /// False if a component of z is NaN or infinite.
  bool finite_point(const Eigen::VectorXd& z);

  /// Reason of the latest failed evaluation; empty if none failed since forget_failure().
  const std::string& failure() const { return failure_; }
  void forget_failure() {
    if (!broken_) failure_.clear();
  }
  /// True after an exception other than NumericalError: a programming error, no shorter step helps.
  bool broken() const { return broken_; }
  const SolveTimes& times() const { return times_; }  ///< spent in the problem's functions

 private:
  template <typename Evaluate>
  bool evaluate(const char* what, double& seconds, Evaluate&& evaluate);
  template <typename Describe>
  bool finite(const char* what, const Eigen::Ref<const Eigen::VectorXd>& values, Describe&& describe);
  std::string describe_entry(const SparsityPattern& pattern, int entry, bool rows_are_constraints) const;

  Nlp& nlp_;
  std::string failure_;
  bool broken_ = false;
  SolveTimes times_;
};

}  // namespace prowl
