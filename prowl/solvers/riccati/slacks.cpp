#include "prowl/solvers/riccati/slacks.hpp"

#include <algorithm>
#include <cmath>

namespace prowl {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kSlackRounding = 1e-13;  ///< relative to max(1, |inequality|)

}  // namespace

Slacks::Slacks(const VectorXd& lower, const VectorXd& upper)
    : s(VectorXd::Zero(lower.size())), lower_(lower), upper_(upper) {
  for (Index i = 0; i < lower.size(); ++i) {
    if (std::isfinite(lower(i))) below_.push_back({i, lower(i)});
    if (std::isfinite(upper(i))) above_.push_back({i, upper(i)});
  }
}

/// Calls visit(bound, distance, sign), sign = d distance / ds.
template <class Self, class Visit>
void Slacks::for_each(Self& self, Visit visit) {
  for (auto& bound : self.below_) visit(bound, self.distance_below(bound), 1.0);
  for (auto& bound : self.above_) visit(bound, self.distance_above(bound), -1.0);
}

void Slacks::initialise(const VectorXd& values, double push) {
  s = values;
  const auto margin = [&](const Bound& b) {
    return push * std::min(std::max(1.0, std::abs(b.at)), upper_(b.row) - lower_(b.row));
  };
  for (const Bound& b : below_) s(b.row) = std::max(s(b.row), b.at + margin(b));
  for (const Bound& b : above_) s(b.row) = std::min(s(b.row), b.at - margin(b));
}

void Slacks::center(double mu) {
  for_each(*this, [mu](Bound& b, double distance, double) { b.z = mu / distance; });
}

void Slacks::initialise(const VectorXd& values, const VectorXd& lambda, double mu, double push) {
  initialise(values, push);
  for_each(*this, [&](Bound& b, double, double sign) {
    b.z = std::max(0.0, -sign * lambda(b.row));
    const double inside = sign * (values(b.row) - b.at);
    const double wanted = std::max(inside, mu / std::max(b.z, mu / push));
    if (sign * (s(b.row) - b.at) > wanted) s(b.row) = b.at + sign * wanted;
  });
  for_each(*this, [&](Bound& b, double distance, double) { b.z = std::max(b.z, mu / distance); });
}

double Slacks::log_barrier() const {
  double sum = 0.0;
  for_each(*this, [&](const Bound&, double distance, double) { sum -= std::log(distance); });
  return sum;
}

void Slacks::pull(double mu, VectorXd& beta) const {
  beta.setZero(size());
  for_each(*this, [&](const Bound& b, double distance, double sign) { beta(b.row) -= sign * mu / distance; });
}

void Slacks::weights(VectorXd& sigma) const {
  sigma.setZero(size());
  for_each(*this, [&](const Bound& b, double distance, double) { sigma(b.row) += b.z / distance; });
}

void Slacks::set_step(double mu, const VectorXd& ds) {
  for_each(*this,
           [&](Bound& b, double distance, double sign) { b.dz = (mu - b.z * sign * ds(b.row)) / distance - b.z; });
}

double Slacks::longest_primal(double tau, const VectorXd& ds) const {
  double alpha = 1.0;
  for_each(*this, [&](const Bound& b, double distance, double sign) {
    const double change = sign * ds(b.row);
    if (change < 0.0) alpha = std::min(alpha, -tau * distance / change);
  });
  return alpha;
}

double Slacks::longest_dual(double tau) const {
  double alpha = 1.0;
  for_each(*this, [&](const Bound& b, double, double) {
    if (b.dz < 0.0) alpha = std::min(alpha, -tau * b.z / b.dz);
  });
  return alpha;
}

bool Slacks::move(const VectorXd& from, double alpha, const VectorXd& ds) {
  s = from + alpha * ds;
  bool inside = true;
  for_each(*this, [&](const Bound&, double distance, double) { inside = inside && distance > 0.0; });
  return inside;
}

void Slacks::reset(const VectorXd& from, const VectorXd& values, double tau) {
  outside_.assign(static_cast<std::size_t>(size()), false);
  const auto check = [&](const Bound& b, double sign) {
    const double least = (1.0 - tau) * sign * (from(b.row) - b.at);
    if (!(sign * (values(b.row) - b.at) > least)) outside_[b.row] = true;
  };
  for (const Bound& b : below_) check(b, 1.0);
  for (const Bound& b : above_) check(b, -1.0);
  for (Index i = 0; i < size(); ++i) {
    const double rounding = kSlackRounding * std::max(1.0, std::abs(values(i)));
    if (!outside_[i] && std::abs(values(i) - s(i)) > rounding) s(i) = values(i);
  }
}

void Slacks::move_dual(double alpha, double mu, double spread) {
  for_each(*this, [&](Bound& b, double distance, double) {
    const double center = mu / distance;
    b.z = std::clamp(b.z + alpha * b.dz, center / spread, center * spread);
  });
}

double Slacks::largest_complementarity(double mu) const {
  double largest = 0.0;
  for_each(*this, [&](const Bound& b, double distance, double) {
    largest = std::max(largest, std::abs(b.z * distance - mu));
  });
  return largest;
}

double Slacks::largest_dual_violation(const VectorXd& lambda) const {
  double largest = 0.0;
  auto below = below_.begin(), above = above_.begin();  // in the order of rows
  for (Index i = 0; i < lambda.size(); ++i) {
    double sum = lambda(i);
    if (below != below_.end() && below->row == i) sum += below++->z;
    if (above != above_.end() && above->row == i) sum -= above++->z;
    largest = std::max(largest, std::abs(sum));
  }
  return largest;
}

double Slacks::sum_of_multipliers() const {
  double sum = 0.0;
  for_each(*this, [&](const Bound& b, double, double) { sum += b.z; });
  return sum;
}

}  // namespace prowl
