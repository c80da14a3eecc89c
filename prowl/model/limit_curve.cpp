#include "prowl/model/limit_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prowl/error.hpp"

namespace prowl {

namespace {

void check(const LimitCurve::Table& table) {
  if (table.size() < LimitCurve::kFewestPoints) {
    throw InputError(fmt::format("a limit curve of {} points is not allowed; need {} or more", table.size(),
                                 LimitCurve::kFewestPoints));
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto& [x, limit] = table[i];
    if (!std::isfinite(x) || !std::isfinite(limit) || !(limit > 0.0)) {
      throw InputError(fmt::format("point {} of the limit curve, ({:g}, {:g}), is not allowed; need a finite place and a "
                                   "limit > 0", i + 1, x, limit));
    }
    if (i > 0 && !(x > table[i - 1].first)) {
      throw InputError(fmt::format("point {} of the limit curve is at {:g}, not after the one before it at {:g}", i + 1, x,
                                   table[i - 1].first));
    }
  }
}

Eigen::Spline<double, 1, 3> interpolate(const LimitCurve::Table& table) {
  Eigen::RowVectorXd limits(static_cast<Eigen::Index>(table.size())), places(limits.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    limits(static_cast<Eigen::Index>(i)) = table[i].second;
    places(static_cast<Eigen::Index>(i)) = (table[i].first - table.front().first) /
                                           (table.back().first - table.front().first);
  }
  return Eigen::SplineFitting<Eigen::Spline<double, 1, 3>>::Interpolate(limits, 3, places);
}

}  // namespace

LimitCurve::LimitCurve(const Table& table)
    : first_((check(table), table.front().first)), last_(table.back().first), spline_(interpolate(table)) {
  for (const auto& [x, limit] : table) largest_ = std::max(largest_, limit);
  constexpr int kSamples = 1000;  // a cubic that dips below zero between so many points does so by nothing
  for (int i = 0; i <= kSamples; ++i) {
    const double x = first_ + (last_ - first_) * i / kSamples;
    if (value(x) > 0.0) continue;
    throw InputError(fmt::format("the limit curve through these points is {:g} at {:g}; need > 0 everywhere: give more "
                                 "points there", value(x), x));
  }
}

LimitCurve::Values LimitCurve::at(double x) const {
  const double inside = std::clamp(x, first_, last_), length = last_ - first_;
  const auto derivatives = spline_.derivatives<2>((inside - first_) / length);
  Values values{derivatives(0), derivatives(1) / length, derivatives(2) / (length * length)};
  if (x != inside) {
    values.value += values.slope * (x - inside);
    values.curvature = 0.0;
  }
  return values;
}

}  // namespace prowl
