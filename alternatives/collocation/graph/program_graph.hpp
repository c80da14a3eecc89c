#pragma once

#include <Eigen/Core>
#include <vector>

#include "alternatives/collocation/graph/differentiable_function.hpp"

namespace prowl {

/// Step h of an interval: fixed, or a share of a local variable, the duration.
struct StepSize {
  double fixed = 0.0;  ///< [s], if variable < 0
  int variable = -1;   ///< local index of the duration
  double share = 0.0;  ///< h = share * duration
};

/// A piece of a nonlinear program in a few local variables: a graph of vectors computed from each
/// other by sums with powers of the step h and by Functions. First derivatives are forward mode,
/// the Hessian of a weighted sum of vectors is reverse mode. An integration rule is then a few
/// lines with exact derivatives.
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
  using Pattern = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic>;  ///< 1 where an entry may be non-zero

  ProgramGraph(int num_locals, const StepSize& step) : num_locals_(num_locals), step_(step) {}

  int num_locals() const { return num_locals_; }
  int size(Vector v) const { return node(v).size; }

  Vector variables(int first, int size);
  /// A vector of another graph: value and derivatives are passed in, the adjoint out.
  Vector outside(int size, Pattern pattern);
  Vector slice(Vector of, int first, int size);
  Vector sum(std::vector<Term> terms);
  /// `function` must outlive the graph; its argument is the concatenation of `inputs`.
  Vector call(DifferentiableFunction& function, std::vector<Vector> inputs);

  const Pattern& pattern(Vector v) const { return node(v).pattern; }
  /// Symmetric pattern of the Hessian of any weighted sum of the vectors.
  Pattern hessian_pattern() const;

  // Call order: outside vectors, evaluate(), then the rest.
  void set_outside(Vector v, const Eigen::VectorXd& value);
  void set_outside_derivative(Vector v, const Eigen::MatrixXd& derivative);
  void evaluate(const Eigen::VectorXd& locals, bool with_derivatives);
  const Eigen::VectorXd& value(Vector v) const { return node(v).value; }
  const Eigen::MatrixXd& derivative(Vector v) const { return node(v).derivative; }  ///< in the local variables

  /// Set weights of the vectors (zero by default), then add their Hessian to `result` (num_locals()
  /// square).
  void clear_weights();
  Eigen::VectorXd& weights(Vector v) { return node(v).weights; }
  void add_hessian(Eigen::MatrixXd& result);

 private:
  enum class Kind { variables, outside, slice, sum, call };
  struct Node {
    Kind kind;
    int size;
    int first = 0;
    std::vector<Term> terms = {};  ///< of a sum; inputs of slice and call
    DifferentiableFunction* function = nullptr;
    std::vector<int> active = {};  ///< of a call: local variables that its inputs depend on
    bool is_direct = false;        ///< of a call: its inputs are local variables
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
  /// Derivatives of a call's inputs in its active local variables.
  Eigen::MatrixXd gathered(const Node& call) const;

  int num_locals_;
  StepSize step_;
  double h_ = 0.0;
  std::vector<Node> nodes_;
};

}  // namespace prowl
