#include "prowl/mpc/barrier_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prowl {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Part of a distance or multiplier that a step leaves at least.
constexpr double kKept = 0.05;
/// Multipliers stay within this factor of mu / d, as in Wächter and Biegler 2006, eq. (16).
constexpr double kSpread = 1e10;
constexpr double kLeastDistance = 1e-9;

}  // namespace

template <class Rows, class Each>
void BarrierRows::for_each_bound(Rows& rows, const Each& each) {
  for (auto* const side : {&rows.lower_, &rows.upper_}) {
    for (Index row = 0; row < rows.size(); ++row) {
      if (rows.is_bound(*side, row)) each(*side, row);
    }
  }
}

BarrierRows::BarrierRows(Index rows) : penalty_(VectorXd::Constant(rows, kHard)), change_(VectorXd::Zero(rows)) {
  lower_.sign = 1.0;
  upper_.sign = -1.0;
  for (Side* side : {&lower_, &upper_}) {
    side->at.setConstant(rows, -side->sign * kHard);
    side->d.setOnes(rows);
    side->z.setZero(rows);
    side->t.setZero(rows);
    side->zd.setZero(rows);
    side->yt.setZero(rows);
    side->target.setZero(rows);
    side->compliance.setOnes(rows);
    side->gap.setZero(rows);
    for (VectorXd* step : {&side->d_step, &side->z_step, &side->t_step}) step->setZero(rows);
  }
}

void BarrierRows::set_bounds(Index row, double lower, double upper, double penalty) {
  for (const auto& [side, at] : {std::pair(&lower_, lower), std::pair(&upper_, upper)}) {
    if (!is_bound(*side, row)) side->z(row) = 0.0;
    side->at(row) = at;
  }
  penalty_(row) = penalty;
}

void BarrierRows::reset() {
  lower_.z.setZero();
  upper_.z.setZero();
}

/// On the central path of this value: z (gap + t) = mu, (penalty - z) t = mu.
void BarrierRows::center(Side& side, Index row, double value, double mu) {
  const double g = gap(side, row, value);
  if (!is_soft(row)) {
    side.d(row) = std::max(g, std::sqrt(mu));
    side.z(row) = mu / side.d(row);
    side.t(row) = 0.0;
    return;
  }
  // (d - t = g, mu / d + mu / t = penalty): penalty t^2 + (penalty g - 2 mu) t - mu g = 0
  const double rho = penalty_(row), b = rho * g - 2.0 * mu;
  const double root = std::hypot(rho * g, 2.0 * mu);  // b^2 + 4 rho mu g = (rho g)^2 + (2 mu)^2
  const double t = b > 0.0 ? 2.0 * mu * g / (b + root) : (root - b) / (2.0 * rho);
  side.t(row) = std::max(t, mu / rho);
  side.d(row) = std::max(g + side.t(row), mu / rho);
  side.z(row) = std::min(mu / side.d(row), 0.999 * rho);
}

void BarrierRows::copy(const BarrierRows& from, double factor) {
  const auto take = [factor](const Side& source, Side& side) {
    side.at = source.at;
    side.d = source.d;
    side.z = factor * source.z;
    side.t = source.t;
  };
  take(from.lower_, lower_);
  take(from.upper_, upper_);
}

void BarrierRows::open(const VectorXd& values, double mu, double distance) {
  for_each_bound(*this, [&](Side& side, Index row) {
    double &d = side.d(row), &z = side.z(row), &t = side.t(row);
    const double g = gap(side, row, values(row));
    d = std::max({d, g, distance});
    z = std::max(z, mu / d);
    if (!is_soft(row)) return;
    const double rho = penalty_(row);
    t = std::max(d - g, std::min(distance, mu / rho));
    z = std::clamp(z, std::min(mu / d, 0.5 * rho), std::max(0.5 * rho, rho - mu / t));
  });
}

void BarrierRows::linearise(const VectorXd& values, double mu, VectorXd& weights) {
  weights.setZero(size());
  for_each_bound(*this, [&](Side& side, Index row) {
    if (!(side.z(row) > 0.0)) center(side, row, values(row), mu);
    double &z = side.z(row), &t = side.t(row);
    double compliance = side.d(row) / z;
    if (is_soft(row)) {
      // A penalty or a multiplier that was just scaled may not fit any more.
      z = std::min(z, 0.999 * penalty_(row));
      const double y = penalty_(row) - z;
      if (!(t > 0.0)) t = mu / y;
      compliance = side.d(row) / z + t / y;
    }
    side.gap(row) = gap(side, row, values(row));
    side.compliance(row) = compliance;
    weights(row) += 1.0 / compliance;
  });
}

void BarrierRows::set_target(Side& side, Index row, VectorXd& pull) {
  const double d = side.d(row), z = side.z(row), t = side.t(row);
  double target = side.zd(row) / z - d;
  if (is_soft(row)) target -= side.yt(row) / (penalty_(row) - z) - t;
  target -= side.gap(row) - (d - elastic(side, row));
  side.target(row) = target;
  pull(row) -= side.sign * (z + target / side.compliance(row));
}

void BarrierRows::aim(double mu, VectorXd& pull) {
  mu_ = mu;
  pull.setZero(size());
  for_each_bound(*this, [&](Side& side, Index row) {
    side.zd(row) = side.yt(row) = mu;
    set_target(side, row, pull);
  });
}

void BarrierRows::find_steps(const VectorXd& change) {
  change_ = change;
  for_each_bound(*this, [&](Side& side, Index row) {
    const double d = side.d(row), z = side.z(row), t = side.t(row), y = penalty_(row) - z;
    const double dz = (side.target(row) - side.sign * change(row)) / side.compliance(row);
    side.z_step(row) = dz;
    side.d_step(row) = side.zd(row) / z - d - d / z * dz;
    side.t_step(row) = is_soft(row) ? side.yt(row) / y - t + t / y * dz : 0.0;
  });
}

void BarrierRows::correct(double mu, VectorXd& pull) {
  mu_ = mu;
  pull.setZero(size());
  for_each_bound(*this, [&](Side& side, Index row) {
    side.zd(row) = mu - side.z_step(row) * side.d_step(row);
    side.yt(row) = mu + side.z_step(row) * side.t_step(row);
    set_target(side, row, pull);
  });
}

double BarrierRows::longest() const {
  double share = 1.0;
  const auto keep = [&share](double value, double step) {
    if (step < 0.0) share = std::min(share, -(1.0 - kKept) * value / step);
  };
  for_each_bound(*this, [&](const Side& side, Index row) {
    keep(side.d(row), side.d_step(row));
    keep(side.t(row), side.t_step(row));
  });
  return share;
}

double BarrierRows::products(double share) const {
  double sum = 0.0;
  for_each_bound(*this, [&](const Side& side, Index row) {
    const double z = side.z(row) + share * side.z_step(row);
    sum += z * (side.d(row) + share * side.d_step(row));
    if (is_soft(row)) sum += (penalty_(row) - z) * (side.t(row) + share * side.t_step(row));
  });
  return sum;
}

int BarrierRows::num_products() const {
  int count = 0;
  for_each_bound(*this, [&](const Side&, Index row) { count += is_soft(row) ? 2 : 1; });
  return count;
}

double BarrierRows::step(double share) {
  double farthest = 0.0;
  for_each_bound(*this, [&](Side& side, Index row) {
    double &d = side.d(row), &z = side.z(row), &t = side.t(row);
    if (is_soft(row)) {
      const double y = penalty_(row) - z;
      t = std::max(t + share * side.t_step(row), kKept * t);
      z = std::clamp(z + side.z_step(row), kKept * z, penalty_(row) - kKept * y);
    } else {
      z = std::max(z + side.z_step(row), kKept * z);
    }
    d = std::max({d + share * side.d_step(row), kKept * d, kLeastDistance});
    const double central = mu_ / d;
    z = std::clamp(z, central / kSpread, central * kSpread);
    const double now = side.gap(row) + side.sign * share * change_(row);
    farthest = std::max(farthest, std::abs(now - (d - elastic(side, row))));
  });
  return farthest;
}

void BarrierRows::multipliers(VectorXd& result) const {
  result.setZero(size());
  for_each_bound(*this, [&](const Side& side, Index row) { result(row) -= side.sign * side.z(row); });
}

}  // namespace prowl
