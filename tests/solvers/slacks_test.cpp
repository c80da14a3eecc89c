#include "prowl/solvers/riccati/slacks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/random_vector.hpp"

namespace prowl {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::random_vector;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kRows = 6;

/// Both bounds, one, none; far from each other and near.
const VectorXd kLower = (VectorXd(kRows) << -1.0, 0.5, -kInfinity, -kInfinity, 100.0, 2.0).finished();
const VectorXd kUpper = (VectorXd(kRows) << 1.0, kInfinity, -0.5, kInfinity, 5e4, 2.0 + 1e-6).finished();

/// Inside, at random.
Slacks random_slacks(std::mt19937& rng) {
  Slacks slacks(kLower, kUpper);
  const VectorXd part = random_vector(rng, kRows, 0.5).array() + 0.5;  // in [0, 1]
  for (Index i = 0; i < kRows; ++i) {
    const double low = std::isfinite(kLower(i)) ? kLower(i) : std::min(kUpper(i), 0.0) - 10.0;
    const double up = std::isfinite(kUpper(i)) ? kUpper(i) : std::max(kLower(i), 0.0) + 10.0;
    slacks.s(i) = low + (0.05 + 0.9 * part(i)) * (up - low);
  }
  return slacks;
}

VectorXd distances(const Slacks& slacks) {
  VectorXd all(2 * kRows);
  all << slacks.s - kLower, kUpper - slacks.s;
  return all;
}

TEST(Slacks, CountTheBoundsThatAreFinite) {
  EXPECT_EQ(Slacks(kLower, kUpper).num_bounds(), 8);
  EXPECT_EQ(Slacks(VectorXd(), VectorXd()).num_bounds(), 0);
}

TEST(Slacks, BeginAtTheValuesButInside) {
  std::mt19937 rng(1);
  constexpr double push = 1e-2;
  const auto clearance = [](Index i, double bound) {
    return push * std::min(std::max(1.0, std::abs(bound)), kUpper(i) - kLower(i));
  };
  int moved = 0, kept = 0;
  for (int repeat = 0; repeat < 100; ++repeat) {
    const VectorXd values = random_vector(rng, kRows, 3.0);
    Slacks slacks(kLower, kUpper);
    slacks.initialise(values, push);
    for (Index i = 0; i < kRows; ++i) {
      bool is_clear = true;
      for (const double bound : {kLower(i), kUpper(i)}) {
        if (!std::isfinite(bound)) continue;
        const double margin = clearance(i, bound);
        is_clear = is_clear && (bound == kLower(i) ? values(i) - bound : bound - values(i)) >= margin;
        const double rounding = 1e-12 * std::max(1.0, std::abs(bound));
        EXPECT_GE(bound == kLower(i) ? slacks.s(i) - bound : bound - slacks.s(i), margin - rounding);
      }
      if (is_clear) EXPECT_EQ(slacks.s(i), values(i));
      ++(is_clear ? kept : moved);
    }
  }
  EXPECT_GT(moved, 10);
  EXPECT_GT(kept, 10);
}

TEST(Slacks, PullIsTheDerivativeOfTheBarrier) {
  std::mt19937 rng(2);
  constexpr double mu = 0.3;
  for (int repeat = 0; repeat < 20; ++repeat) {
    Slacks slacks = random_slacks(rng);
    VectorXd beta, sigma;
    slacks.pull(mu, beta);
    slacks.center(mu);
    slacks.weights(sigma);
    for (Index i = 0; i < kRows; ++i) {
      const double here = slacks.s(i), h = 1e-5 * std::min(1.0, kUpper(i) - kLower(i));
      const auto moved = [&](double by) {
        slacks.s(i) = here + by;
        VectorXd result;
        slacks.pull(mu, result);
        return std::pair(mu * slacks.log_barrier(), result(i));
      };
      const auto [barrier_plus, slope_plus] = moved(h);
      const auto [barrier_minus, slope_minus] = moved(-h);
      slacks.s(i) = here;
      const double size = std::max(1.0, std::abs(beta(i)));
      EXPECT_NEAR(beta(i), (barrier_plus - barrier_minus) / (2.0 * h), 1e-5 * size) << i;
      EXPECT_NEAR(sigma(i), (slope_plus - slope_minus) / (2.0 * h), 1e-4 * std::max(1.0, sigma(i)))
          << "at the centre weights are the barrier's curvature, row " << i;
    }
    EXPECT_EQ(beta(3), 0.0) << "a row without bounds";
    EXPECT_GT(beta.norm(), 1.0);
  }
}

TEST(Slacks, AreComplementaryAndDualFeasibleAtTheCentre) {
  std::mt19937 rng(3);
  Slacks slacks = random_slacks(rng);
  slacks.center(0.3);
  EXPECT_LT(slacks.largest_complementarity(0.3), 1e-12);
  EXPECT_NEAR(slacks.largest_complementarity(0.1), 0.2, 1e-12);
  VectorXd lambda;
  slacks.pull(0.3, lambda);
  EXPECT_LT(slacks.largest_dual_violation(lambda), 1e-12 * lambda.norm());
  lambda(1) += 0.7;
  EXPECT_NEAR(slacks.largest_dual_violation(lambda), 0.7, 1e-9);
  double sum = 0.0;
  for (const double distance : distances(slacks)) sum += std::isfinite(distance) ? 0.3 / distance : 0.0;
  EXPECT_NEAR(slacks.sum_of_multipliers(), sum, 1e-12 * sum);
}

/// Newton's step for z distance = mu is exact up to the product of both steps.
TEST(Slacks, StepOfMultipliersIsNewtons) {
  constexpr double mu = 0.6;
  Slacks slacks(VectorXd::Zero(1), VectorXd::Constant(1, kInfinity));
  slacks.s << 2.0;
  slacks.center(1.0);  // z = 0.5
  const VectorXd ds = VectorXd::Constant(1, 0.25);
  slacks.set_step(mu, ds);
  const double dz = (mu - 0.5 * 2.0 - 0.5 * 0.25) / 2.0;
  ASSERT_TRUE(slacks.move(slacks.s, 1.0, ds));
  slacks.move_dual(1.0, mu, 1e10);
  EXPECT_NEAR(slacks.sum_of_multipliers(), 0.5 + dz, 1e-15);
  EXPECT_NEAR(slacks.largest_complementarity(mu), std::abs(dz * 0.25), 1e-15);
}

TEST(Slacks, LongestStepsKeepTheirDistance) {
  std::mt19937 rng(4);
  constexpr double tau = 0.9;
  int shortened = 0, whole = 0;
  for (int repeat = 0; repeat < 200; ++repeat) {
    Slacks slacks = random_slacks(rng);
    const VectorXd before = distances(slacks), from = slacks.s;
    const VectorXd ds = random_vector(rng, kRows, repeat % 2 == 0 ? 1e-7 : 3.0);
    const double alpha = slacks.longest_primal(tau, ds);
    ASSERT_GT(alpha, 0.0);
    ASSERT_LE(alpha, 1.0);
    EXPECT_TRUE(slacks.move(from, alpha, ds));
    const VectorXd after = distances(slacks);
    double least = 1.0;
    for (Index i = 0; i < after.size(); ++i) {
      if (std::isfinite(before(i))) least = std::min(least, after(i) / before(i));
    }
    EXPECT_GE(least, (1.0 - tau) * (1.0 - 1e-6));
    if (alpha < 1.0) EXPECT_NEAR(least, 1.0 - tau, 1e-6) << "shorter than it has to be";
    ++(alpha < 1.0 ? shortened : whole);
    if (alpha < tau) EXPECT_FALSE(slacks.move(from, 1.01 * alpha / tau, ds)) << "beyond a bound";
  }
  EXPECT_GT(shortened, 10);
  EXPECT_GT(whole, 10);
}

TEST(Slacks, ResetToTheValuesThatAreFarEnoughInside) {
  std::mt19937 rng(5);
  constexpr double tau = 0.9;
  int taken = 0, left = 0;
  for (int repeat = 0; repeat < 100; ++repeat) {
    Slacks slacks = random_slacks(rng);
    const VectorXd from = slacks.s, before = distances(slacks);
    ASSERT_TRUE(slacks.move(from, slacks.longest_primal(tau, -0.1 * from), -0.1 * from));
    const VectorXd stepped = slacks.s, values = from + random_vector(rng, kRows, repeat % 2 == 0 ? 1e-7 : 3.0);
    slacks.reset(from, values, tau);
    const VectorXd after = distances(slacks);
    for (Index i = 0; i < kRows; ++i) {
      const bool is_taken = slacks.s(i) == values(i);
      EXPECT_TRUE(is_taken || slacks.s(i) == stepped(i));
      ++(is_taken ? taken : left);
      const double below = values(i) - kLower(i), above = kUpper(i) - values(i);
      const bool is_inside = (!std::isfinite(kLower(i)) || below > (1.0 - tau) * before(i)) &&
                             (!std::isfinite(kUpper(i)) || above > (1.0 - tau) * before(kRows + i));
      EXPECT_EQ(is_taken, is_inside) << "row " << i;
      EXPECT_GT(after(i), 0.0);
      EXPECT_GT(after(kRows + i), 0.0);
    }
  }
  EXPECT_GT(taken, 10);
  EXPECT_GT(left, 10);
}

TEST(Slacks, LongestStepsKeepMultipliersPositive) {
  constexpr double tau = 0.9;
  Slacks slacks(VectorXd::Zero(1), VectorXd::Constant(1, kInfinity));
  slacks.s << 1.0;
  slacks.center(1.0);
  slacks.set_step(1e-3, VectorXd::Constant(1, 0.5));  // to mu - z (s + ds) < -z
  const double alpha = slacks.longest_dual(tau);
  EXPECT_LT(alpha, 1.0);
  slacks.move_dual(alpha, 1e-3, 1e10);
  EXPECT_NEAR(slacks.sum_of_multipliers(), 1.0 - tau, 1e-12);

  slacks.set_step(1.0, VectorXd::Zero(1));  // upwards
  EXPECT_EQ(slacks.longest_dual(tau), 1.0);
}

TEST(Slacks, MultipliersStayNearTheCentre) {
  Slacks slacks(VectorXd::Zero(1), VectorXd::Constant(1, kInfinity));
  slacks.s << 2.0;
  for (const double center : {1e3, 1e-3}) {
    slacks.center(center);
    slacks.set_step(center, VectorXd::Zero(1));
    slacks.move_dual(1.0, 0.1, 10.0);
    EXPECT_NEAR(slacks.sum_of_multipliers(), center > 1.0 ? 0.5 : 0.005, 1e-12);
  }
}

TEST(Slacks, ResetLeavesWhatDiffersByRounding) {
  Slacks slacks(VectorXd::Zero(2), VectorXd::Constant(2, 10.0));
  slacks.s = VectorXd::Constant(2, 0.5);
  const VectorXd from = slacks.s;
  slacks.reset(from, Eigen::Vector2d(0.5 + 5e-14, 0.5 + 1e-9), 0.99);
  EXPECT_EQ(slacks.s(0), 0.5);
  EXPECT_EQ(slacks.s(1), 0.5 + 1e-9);
}

}  // namespace
}  // namespace prowl
