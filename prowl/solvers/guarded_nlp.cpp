#include "prowl/solvers/guarded_nlp.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>

#include "prowl/error.hpp"
#include "prowl/nlp/stopwatch.hpp"

namespace prowl {

template <typename Evaluate>
bool GuardedNlp::evaluate(const char* what, double& seconds, Evaluate&& evaluate) {
  if (broken_) return false;
  const Stopwatch stopwatch(seconds);
  bool good = true;
  try {
    evaluate();
  } catch (const NumericalError& error) {
    failure_ = fmt::format("{}: {}", what, error.what());
    good = false;
  } catch (const std::exception& error) {
    failure_ = fmt::format("{} threw: {}", what, error.what());
    good = false;
    broken_ = true;
  } catch (...) {
    failure_ = fmt::format("{} threw something that is not a std::exception", what);
    good = false;
    broken_ = true;
  }
  return good;
}

template <typename Describe>
bool GuardedNlp::finite(const char* what, const Eigen::Ref<const Eigen::VectorXd>& values, Describe&& describe) {
  if (values.allFinite()) return true;
  int i = 0;
  while (std::isfinite(values[i])) ++i;
  failure_ = fmt::format("{} is {} at {}", what, values[i], describe(i));
  return false;
}

std::string GuardedNlp::describe_entry(const SparsityPattern& pattern, int entry, bool rows_are_constraints) const {
  const int row = pattern.rows[entry];
  return fmt::format("{}, by {}", rows_are_constraints ? nlp_.describe_constraint(row) : nlp_.describe_variable(row),
                     nlp_.describe_variable(pattern.cols[entry]));
}

bool GuardedNlp::finite_point(const Eigen::VectorXd& z) {
  return finite("the point", z, [this](int i) { return nlp_.describe_variable(i); });
}

bool GuardedNlp::cost(const Eigen::VectorXd& z, double& value) {
  if (!evaluate("cost", times_.values, [&] { value = nlp_.cost(z); })) return false;
  if (std::isfinite(value)) return true;
  failure_ = fmt::format("cost is {}", value);
  return false;
}

bool GuardedNlp::cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) {
  return evaluate("cost gradient", times_.derivatives, [&] { nlp_.cost_gradient(z, gradient); }) &&
         finite("cost gradient", gradient, [this](int i) { return nlp_.describe_variable(i); });
}

bool GuardedNlp::constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) {
  return evaluate("constraint", times_.values, [&] { nlp_.constraints(z, g); }) &&
         finite("constraint", g, [this](int i) { return nlp_.describe_constraint(i); });
}

bool GuardedNlp::jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) {
  return evaluate("constraint Jacobian", times_.derivatives, [&] { nlp_.jacobian(z, values); }) &&
         finite("constraint Jacobian", values,
                [this](int i) { return describe_entry(nlp_.jacobian_pattern(), i, true); });
}

bool GuardedNlp::hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
                         Eigen::Ref<Eigen::VectorXd> values) {
  return evaluate("Hessian", times_.derivatives, [&] { nlp_.hessian(z, cost_factor, multipliers, values); }) &&
         finite("Hessian", values, [this](int i) { return describe_entry(nlp_.hessian_pattern(), i, false); });
}

}  // namespace prowl
