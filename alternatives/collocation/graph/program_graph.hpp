#pragma once

#include <Eigen/Core>
#include <vector>

#include "alternatives/collocation/graph/function.hpp"

namespace prowl {

/// The step h of an interval: fixed, or a share of a duration that is a local variable.
struct StepSize {
  double fixed = 0.0;  ///< [s], if variable < 0
  int variable = -1;   ///< local index of the duration
  double share = 0.0;  ///< h = share * duration
};

/// A piece of a nonlinear program in a few local variables, as vectors that follow from each other: sums with powers of
/// the step h, and Functions. Derivatives of all vectors in the local variables go forward with the values; the Hessian
/// of a weighted sum of them comes back in the opposite order, as the adjoints do. So a rule of integration is a few
/// lines that look like the rule, and has exact derivatives.
class ProgramGraph {
 public:
  struct Vector {
    int index = -1;
  };
  /// factor * h^power * vector
  struct Term {
    double factor = 0.0;
    int power = 0;
    Vector vector;
  };
  using Pattern = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic>;  ///< 1 where an entry may differ from zero

  ProgramGraph(int num_locals, const StepSize& step) : num_locals_(num_locals), step_(step) {}

  int num_locals() const { return num_locals_; }
  int size(Vector v) const { return node(v).size; }

  Vector variables(int first, int size);
  /// A vector that another graph computes: its value, derivatives and adjoint are passed in and out.
  Vector outside(int size, Pattern pattern);
  Vector slice(Vector of, int first, int size);
  Vector sum(std::vector<Term> terms);
  /// `function` must outlive the graph. The inputs in a row are its argument.
  Vector call(Function& function, std::vector<Vector> inputs);

  const Pattern& pattern(Vector v) const { return node(v).pattern; }
  /// Of the Hessian of any weighted sum of the vectors, symmetric.
  Pattern hessian_pattern() const;

  // In this order: outside vectors, then evaluate, then what depends on it.
  void set_outside(Vector v, const Eigen::VectorXd& value);
  void set_outside_derivative(Vector v, const Eigen::MatrixXd& derivative);
  void evaluate(const Eigen::VectorXd& locals, bool with_derivatives);
  const Eigen::VectorXd& value(Vector v) const { return node(v).value; }
  const Eigen::MatrixXd& derivative(Vector v) const { return node(v).derivative; }  ///< in the local variables

  /// Weights of the vectors, zero at first; then their Hessian is added to `result` (num_locals() square).
  void clear_weights();
  Eigen::VectorXd& weights(Vector v) { return node(v).weights; }
  void add_hessian(Eigen::MatrixXd& result);

 private:
  enum class Kind { variables, outside, slice, sum, call };
  struct Node {
    Kind kind;
    int size;
    int first = 0;
    std::vector<Term> terms = {};  ///< of a sum; of slice and call their inputs
    Function* function = nullptr;
    std::vector<int> active = {};  ///< of a call: local variables that its inputs depend on
    bool is_direct = false;        ///< of a call: its inputs are those variables themselves
    Pattern pattern = {};
    Eigen::VectorXd value = {}, weights = {}, inputs = {};
    Eigen::MatrixXd derivative = {}, slope = {};  ///< in the local variables; of the function
  };
  Node& node(Vector v) { return nodes_[v.index]; }
  const Node& node(Vector v) const { return nodes_[v.index]; }
  Vector add(Node node);
  double step_power(int power) const;        ///< h^power
  double step_power_slope(int power) const;  ///< its derivative in the duration
  void evaluate_sum(Node& node, bool with_derivatives);
  void evaluate_call(Node& node, bool with_derivatives);
  void pull_back_sum(const Node& node, Eigen::MatrixXd& result);
  void pull_back_call(Node& node, Eigen::MatrixXd& result);
  /// Derivatives of a call's inputs in its active variables.
  Eigen::MatrixXd gathered(const Node& call) const;

  int num_locals_;
  StepSize step_;
  double h_ = 0.0;
  std::vector<Node> nodes_;
};

}  // namespace prowl
