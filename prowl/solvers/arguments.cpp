#include "prowl/solvers/arguments.hpp"

#include <fmt/format.h>

#include "prowl/error.hpp"

namespace prowl {

void check_arguments(const Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) {
  validate(options);
  if (z_guess.size() == nlp.num_variables()) return;
  throw InputError(fmt::format("start has {} variables, the problem has {}", z_guess.size(), nlp.num_variables()));
}

std::optional<std::string> why_nothing_left(const Nlp& nlp) {
  const auto why = [](const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                      auto describe) -> std::optional<std::string> {
    for (int i = 0; i < lower.size(); ++i) {
      if (lower[i] <= upper[i]) continue;  // false for NaN too
      return fmt::format("{}: bounds [{}, {}] contain no value", describe(i), lower[i], upper[i]);
    }
    return std::nullopt;
  };
  if (auto reason = why(nlp.variable_lower(), nlp.variable_upper(), [&](int i) { return nlp.describe_variable(i); })) {
    return reason;
  }
  return why(nlp.constraint_lower(), nlp.constraint_upper(), [&](int i) { return nlp.describe_constraint(i); });
}

std::optional<std::string> why_no_chain(Nlp& nlp, const std::string& solver) {
  const StagewiseNlp* stages = nlp.stagewise();
  if (!stages) return solver + " needs a problem that is a chain of stages; this one is not";
  for (int k = 0; k < stages->num_stages(); ++k) {
    for (int i = 0; i < stages->size(k).inequalities; ++i) {
      if (stages->lower(k)(i) < stages->upper(k)(i)) continue;  // false for NaN too
      return fmt::format("{}: bounds [{}, {}] contain no interior", stages->describe_stage(k), stages->lower(k)(i),
                         stages->upper(k)(i));
    }
  }
  return std::nullopt;
}

}  // namespace prowl
