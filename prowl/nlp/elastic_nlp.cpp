#include "prowl/nlp/elastic_nlp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Margin of a slack at the start, in sizes: an interior-point method needs room.
constexpr double kRoom = 1e-2;

}  // namespace

ElasticNlp::ElasticNlp(Nlp& inner, std::vector<SoftBound> soft, double cost_factor)
    : inner_(inner), soft_(std::move(soft)), cost_factor_(cost_factor) {
  const int variables = inner.num_variables(), rows = inner.num_constraints();
  std::vector<double> lower(inner.constraint_lower().begin(), inner.constraint_lower().end());
  std::vector<double> upper(inner.constraint_upper().begin(), inner.constraint_upper().end());
  VectorXd z_lower = inner.variable_lower(), z_upper = inner.variable_upper();
  jacobian_pattern_ = inner.jacobian_pattern();
  hessian_pattern_ = inner.hessian_pattern();
  const auto emit = [&](int row, int col) {
    jacobian_pattern_.rows.push_back(row);
    jacobian_pattern_.cols.push_back(col);
  };
  std::vector<int> row_of_soft;
  for (const SoftBound& bound : soft_) {
    row_of_soft.push_back(bound.is_row ? bound.index : rows + static_cast<int>(variables_.size()));
    if (bound.is_row) continue;
    emit(row_of_soft.back(), bound.index);
    variables_.push_back(bound.index);
    lower.push_back(z_lower(bound.index));
    upper.push_back(z_upper(bound.index));
    z_lower(bound.index) = -kInfinity;
    z_upper(bound.index) = kInfinity;
  }
  for (int i = 0; i < static_cast<int>(soft_.size()); ++i) {
    const int row = row_of_soft[i];
    if (lower[row] > -kInfinity) slacks_.push_back({i, row, 1.0});
    if (upper[row] < kInfinity) slacks_.push_back({i, row, -1.0});
  }
  const auto count = static_cast<Index>(slacks_.size());
  price_.resize(count);
  for (Index s = 0; s < count; ++s) {
    const Slack& slack = slacks_[s];
    emit(slack.row, variables + static_cast<int>(s));
    price_(s) = soft_[slack.soft].price;
  }
  variable_lower_.resize(variables + count);
  variable_lower_ << z_lower, VectorXd::Zero(count);
  variable_upper_.resize(variables + count);
  variable_upper_ << z_upper, VectorXd::Constant(count, kInfinity);
  constraint_lower_ = Eigen::Map<const VectorXd>(lower.data(), static_cast<Index>(lower.size()));
  constraint_upper_ = Eigen::Map<const VectorXd>(upper.data(), static_cast<Index>(upper.size()));
}

VectorXd ElasticNlp::with_slacks(const VectorXd& z) {
  VectorXd result(num_variables()), g(num_constraints());
  result << z, VectorXd::Zero(price_.size());
  constraints(result, g);
  for (Index s = 0; s < price_.size(); ++s) {
    const Slack& slack = slacks_[s];
    const double bound = slack.sign > 0.0 ? constraint_lower_(slack.row) : constraint_upper_(slack.row);
    const double missing = std::max(slack.sign * (bound - g(slack.row)), 0.0);
    result(z.size() + s) = missing / soft_[slack.soft].size + kRoom;
  }
  return result;
}

VectorXd ElasticNlp::violations(const VectorXd& z) const {
  VectorXd result = VectorXd::Zero(static_cast<Index>(soft_.size()));
  for (Index s = 0; s < price_.size(); ++s) {
    const Slack& slack = slacks_[s];
    result(slack.soft) += slack.sign * soft_[slack.soft].size * z(inner_.num_variables() + s);
  }
  return result;
}

double ElasticNlp::cost(const VectorXd& z) {
  return cost_factor_ * inner_.cost(inner(z)) + price_.dot(z.tail(price_.size()));
}

void ElasticNlp::cost_gradient(const VectorXd& z, Eigen::Ref<VectorXd> gradient) {
  inner_.cost_gradient(inner(z), gradient.head(inner_.num_variables()));
  gradient.head(inner_.num_variables()) *= cost_factor_;
  gradient.tail(price_.size()) = price_;
}

void ElasticNlp::constraints(const VectorXd& z, Eigen::Ref<VectorXd> g) {
  inner_.constraints(inner(z), g.head(inner_.num_constraints()));
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    g(inner_.num_constraints() + static_cast<Index>(i)) = z(variables_[i]);
  }
  for (Index s = 0; s < price_.size(); ++s) {
    const Slack& slack = slacks_[s];
    g(slack.row) += slack.sign * soft_[slack.soft].size * z(inner_.num_variables() + s);
  }
}

void ElasticNlp::jacobian(const VectorXd& z, Eigen::Ref<VectorXd> values) {
  const Index own = inner_.jacobian_pattern().size(), soft = static_cast<Index>(variables_.size());
  inner_.jacobian(inner(z), values.head(own));
  values.segment(own, soft).setOnes();
  for (Index s = 0; s < price_.size(); ++s) {
    const Slack& slack = slacks_[s];
    values(own + soft + s) = slack.sign * soft_[slack.soft].size;
  }
}

void ElasticNlp::hessian(const VectorXd& z, double cost_factor, const VectorXd& multipliers,
                         Eigen::Ref<VectorXd> values) {
  inner_.hessian(inner(z), cost_factor * cost_factor_, multipliers.head(inner_.num_constraints()), values);
}

std::string ElasticNlp::describe_constraint(int row) const {
  const int own = inner_.num_constraints();
  return row < own ? inner_.describe_constraint(row)
                   : inner_.describe_variable(variables_[row - own]) + ", soft bounds";
}

std::string ElasticNlp::describe_variable(int index) const {
  const int own = inner_.num_variables();
  if (index < own) return inner_.describe_variable(index);
  const Slack& slack = slacks_[index - own];
  return describe_constraint(slack.row) + (slack.sign > 0.0 ? ", violated below" : ", violated above");
}

}  // namespace prowl
