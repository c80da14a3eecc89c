// Minimise 1/2 (x - c)^2 for one bounded variable by the rows' Newton steps.
#include "prowl/mpc/barrier_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace prowl {
namespace {

using Eigen::VectorXd;

constexpr double kBarrier = 1e-8;

/// x after some iterations from a start, feasible or not.
double minimise(BarrierRows& rows, double goal, double x, int iterations) {
  VectorXd values(1), weights, pull;
  for (int i = 0; i < iterations; ++i) {
    values(0) = x;
    rows.linearise(values, kBarrier, weights);
    rows.aim(kBarrier, pull);
    const double step = -(x - goal + pull(0)) / (1.0 + weights(0));
    rows.find_steps(VectorXd::Constant(1, step));
    rows.step();
    x += step;
  }
  return x;
}

TEST(BarrierRows, KeepsHardBounds) {
  for (const double start : {-3.0, 0.2, 0.999, 5.0}) {
    BarrierRows rows(1);
    rows.set_bounds(0, 0.0, 1.0, BarrierRows::kHard);
    EXPECT_NEAR(minimise(rows, 2.0, start, 30), 1.0, 1e-6) << start;
    EXPECT_NEAR(minimise(rows, -2.0, start, 30), 0.0, 1e-6) << start;
    EXPECT_NEAR(minimise(rows, 0.4, start, 30), 0.4, 1e-6) << start;
    VectorXd multipliers;
    rows.multipliers(multipliers);
    EXPECT_NEAR(multipliers(0), 0.0, 1e-6);
  }
}

TEST(BarrierRows, ThePriceOfASoftBoundIsExact) {
  for (const double start : {-3.0, 0.5, 5.0}) {
    BarrierRows rows(1);
    rows.set_bounds(0, 0.0, 1.0, 10.0);
    EXPECT_NEAR(minimise(rows, 2.0, start, 30), 1.0, 1e-6) << "a pull of 1 is less than its price";
    rows.set_bounds(0, 0.0, 1.0, 0.3);
    EXPECT_NEAR(minimise(rows, 2.0, start, 30), 1.7, 1e-5) << "a pull of 1 buys all but its price";
    EXPECT_NEAR(minimise(rows, -2.0, start, 40), -1.7, 1e-5);
  }
}

TEST(BarrierRows, ABoundThatAppearsStartsOnItsCentralPath) {
  BarrierRows rows(1);
  VectorXd weights, pull;
  rows.linearise(VectorXd::Constant(1, -4.0), kBarrier, weights);
  rows.aim(kBarrier, pull);
  EXPECT_EQ(weights(0), 0.0);
  EXPECT_EQ(pull(0), 0.0);
  rows.set_bounds(0, 0.0, BarrierRows::kHard, BarrierRows::kHard);
  EXPECT_NEAR(minimise(rows, -1.0, -4.0, 30), 0.0, 1e-6);
}

TEST(BarrierRows, TellsHowFarItIsFromTheRows) {
  BarrierRows rows(1);
  rows.set_bounds(0, 0.0, BarrierRows::kHard, BarrierRows::kHard);
  VectorXd weights, pull;
  rows.linearise(VectorXd::Constant(1, 1.0), kBarrier, weights);
  rows.aim(kBarrier, pull);
  rows.find_steps(VectorXd::Constant(1, -0.5));
  EXPECT_LT(rows.step(), 1e-12);
  rows.linearise(VectorXd::Constant(1, 0.5), kBarrier, weights);
  rows.aim(kBarrier, pull);
  rows.find_steps(VectorXd::Constant(1, -2.5));
  EXPECT_GT(rows.step(), 2.0) << "a step far beyond the bound";
}

TEST(BarrierRows, PredictorAndCorrectorFindANewActiveBoundFast) {
  for (const double goal : {-2.0, 0.4, 2.0}) {
    for (const double price : {10.0, BarrierRows::kHard}) {
      BarrierRows rows(1);
      rows.set_bounds(0, 0.0, 1.0, price);
      double x = minimise(rows, goal > 1.0 ? -1.0 : 3.0, 0.5, 30);  // at the other bound
      VectorXd values = VectorXd::Constant(1, x), weights, pull;
      rows.open(values, 1e-2, 0.05);
      for (int i = 0; i < 10; ++i) {
        rows.linearise(values, 1e-2, weights);
        const auto change = [&] {
          return VectorXd(-(values - VectorXd::Constant(1, goal) + pull) / (1.0 + weights(0)));
        };
        rows.aim(0.0, pull);
        rows.find_steps(change());
        const double ahead = rows.products(rows.longest()) / rows.products(0.0);
        rows.correct(std::max(kBarrier, std::pow(ahead, 3) * rows.products(0.0) / rows.num_products()), pull);
        const VectorXd step = change();
        rows.find_steps(step);
        const double share = rows.longest();
        rows.step(share);
        values += share * step;
      }
      EXPECT_NEAR(values(0), std::clamp(goal, 0.0, 1.0), 1e-4) << goal << " " << price;
    }
  }
}

}  // namespace
}  // namespace prowl
