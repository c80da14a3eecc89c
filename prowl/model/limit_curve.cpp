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
  constexpr std::size_t kMostPoints = 200;  // the fit takes a dense matrix of that size
  if (table.size() > kMostPoints) {
    throw InputError(
        fmt::format("a limit curve of {} points is not allowed; need at most {}", table.size(), kMostPoints));
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto& [x, limit] = table[i];
    if (!std::isfinite(x) || !std::isfinite(limit) || !(limit > 0.0)) {
      throw InputError(
          fmt::format("point {} of the limit curve, ({:g}, {:g}), is not allowed; need finite numbers and a "
                      "limit > 0",
                      i + 1, x, limit));
    }
    if (i > 0 && !(x > table[i - 1].first)) {
      throw InputError(fmt::format("point {} of the limit curve is at {:g}; need more than {:g}, the point before",
                                   i + 1, x, table[i - 1].first));
    }
  }
}

Eigen::Spline<double, 1, 3> interpolate(const LimitCurve::Table& table) {
  Eigen::RowVectorXd limits(static_cast<Eigen::Index>(table.size())), parameters(limits.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    limits(static_cast<Eigen::Index>(i)) = table[i].second;
    parameters(static_cast<Eigen::Index>(i)) =
        (table[i].first - table.front().first) / (table.back().first - table.front().first);
  }
  return Eigen::SplineFitting<Eigen::Spline<double, 1, 3>>::Interpolate(limits, 3, parameters);
}

}  // namespace

LimitCurve::LimitCurve(const Table& table)
    : first_((check(table), table.front().first)), last_(table.back().first), spline_(interpolate(table)) {
  for (const auto& [x, limit] : table) largest_ = std::max(largest_, limit);
  constexpr int kSamples = 1000;  // between these a cubic is hardly below zero
  for (int i = 0; i <= kSamples; ++i) {
    const double x = first_ + (last_ - first_) * i / kSamples;
    if (value(x) > 0.0) continue;
    throw InputError(
        fmt::format("the limit curve through these points is {:g} at {:g}; need > 0 everywhere: add points "
                    "there",
                    value(x), x));
  }
}

// De Boor's recursion; Eigen's Spline would allocate. Second differences of the first row of its triangle give the
// second derivative, differences of the second row the first.
LimitCurve::Values LimitCurve::at(double x) const {
  const double inside = std::clamp(x, first_, last_), length = last_ - first_;
  const double u = (inside - first_) / length;
  const auto& t = spline_.knots();
  const Eigen::Index s = spline_.span(u);
  Eigen::Vector4d d = spline_.ctrls().segment<4>(s - 3).transpose();
  const auto refine = [&](Eigen::Index row) {
    for (Eigen::Index j = 3; j >= row; --j) {
      const double before = t(s - 3 + j), after = t(s + 1 + j - row);
      d(j) = ((after - u) * d(j - 1) + (u - before) * d(j)) / (after - before);
    }
  };
  Values values{};
  refine(1);
  const double piece = t(s + 1) - t(s);
  const double bend = (d(3) - d(2)) / (t(s + 2) - t(s)) - (d(2) - d(1)) / (t(s + 1) - t(s - 1));
  values.curvature = 6.0 * bend / (piece * length * length);
  refine(2);
  values.slope = 3.0 * (d(3) - d(2)) / (piece * length);
  refine(3);
  values.value = d(3);
  if (x != inside) {
    values.value += values.slope * (x - inside);
    values.curvature = 0.0;
  }
  return values;
}

}  // namespace prowl
