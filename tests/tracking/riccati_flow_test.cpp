#include "prowl/tracking/riccati_flow.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/support/random_vector.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;

struct System {
  MatrixXd A, G, Q;
};

MatrixXd random_cost(std::mt19937& rng, int n, int rank) {
  const MatrixXd root = test::random_matrix(rng, n, rank);
  return root * root.transpose();
}

/// Unstable and stable directions, fewer inputs than states, Q of the units that robots have: G is large where Q is
/// small.
System random_system(std::mt19937& rng, int n, double input_size) {
  return {test::random_matrix(rng, n, n, 3.0), input_size * random_cost(rng, n, n / 2), random_cost(rng, n, n)};
}

MatrixXd riccati_rate(const System& s, const MatrixXd& S) { return s.A.transpose() * S + S * s.A - S * s.G * S + s.Q; }

/// The Riccati equation itself, by many steps of the classical Runge-Kutta method.
MatrixXd integrate_back(const System& s, MatrixXd S, double time, int steps) {
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const MatrixXd k1 = riccati_rate(s, S), k2 = riccati_rate(s, S + 0.5 * h * k1),
                   k3 = riccati_rate(s, S + 0.5 * h * k2), k4 = riccati_rate(s, S + h * k3);
    S += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return S;
}

TEST(RiccatiFlow, SolvesTheDifferentialEquation) {
  std::mt19937 rng(1);
  for (const double input_size : {1e-3, 1.0, 1e3}) {
    for (int i = 0; i < 20; ++i) {
      const System s = random_system(rng, 6, input_size);
      const MatrixXd S = random_cost(rng, 6, 3) / input_size;
      const MatrixXd expected = integrate_back(s, S, 0.02, 4000);
      const MatrixXd found = riccati_flow(s.A, s.G, s.Q, 0.02).back(S);
      EXPECT_LT(test::relative_error(found, expected), 1e-9) << "inputs of size " << input_size;
      EXPECT_GT(test::relative_error(S, expected), 1e-3) << "nothing happens in this time";
    }
  }
}

TEST(RiccatiFlow, ComposesAndCarriesTheClosedLoop) {
  std::mt19937 rng(2);
  for (int i = 0; i < 20; ++i) {
    const System s = random_system(rng, 8, 1.0);
    const MatrixXd S = random_cost(rng, 8, 8);
    const RiccatiFlow first = riccati_flow(s.A, s.G, s.Q, 0.1), second = riccati_flow(s.A, s.G, s.Q, 0.2),
                      both = riccati_flow(s.A, s.G, s.Q, 0.3), composed = compose(first, second);
    EXPECT_LT(test::relative_error(composed.back(S), both.back(S)), 1e-10);
    EXPECT_LT(test::relative_error(first.back(second.back(S)), both.back(S)), 1e-10);
    EXPECT_LT(test::relative_error(second.closed_loop(S) * first.closed_loop(second.back(S)), both.closed_loop(S)),
              1e-9);
    // x' = (A - G S(t)) x, by small steps backwards in time.
    MatrixXd later = S, transition = MatrixXd::Identity(8, 8);
    constexpr int kSteps = 3000;
    for (int k = 0; k < kSteps; ++k) {
      const MatrixXd earlier = integrate_back(s, later, 0.3 / kSteps, 4);
      const MatrixXd closed = s.A - s.G * 0.5 * (later + earlier);
      const MatrixXd half = MatrixXd::Identity(8, 8) - 0.15 / kSteps * closed;
      transition = (transition * half.partialPivLu().solve(MatrixXd::Identity(8, 8) + 0.15 / kSteps * closed)).eval();
      later = earlier;
    }
    EXPECT_LT(test::relative_error(both.closed_loop(S), transition), 1e-5);
  }
}

// However long the step and large the numbers: symmetric and not negative.
TEST(RiccatiFlow, StaysSymmetricAndPositive) {
  std::mt19937 rng(3);
  for (const double h : {1e-4, 1e-2, 0.3}) {
    for (const double size : {1e-6, 1.0, 1e9}) {
      const System s = random_system(rng, 8, 1.0);
      const MatrixXd S = riccati_flow(s.A, s.G, s.Q, h).back(size * random_cost(rng, 8, 4));
      EXPECT_EQ(S, S.transpose());
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(S).eigenvalues()(0), -1e-12 * S.norm());
    }
  }
}

TEST(RiccatiFlow, FindsTheStabilisingStationarySolution) {
  std::mt19937 rng(4);
  for (int i = 0; i < 20; ++i) {
    const System s = random_system(rng, 6, 10.0);
    const std::optional<MatrixXd> S = stationary_cost(riccati_flow(s.A, s.G, s.Q, 2e-3));
    ASSERT_TRUE(S);
    EXPECT_LT(riccati_rate(s, *S).norm(), 1e-7 * (s.A.norm() * S->norm() + s.Q.norm()));
    EXPECT_LT((s.A - s.G * *S).eigenvalues().real().maxCoeff(), 0.0);
  }
}

TEST(RiccatiFlow, HasNoStationarySolutionWhereNoInputReaches) {
  MatrixXd A = MatrixXd::Zero(2, 2), G = MatrixXd::Zero(2, 2);
  A(0, 0) = 1.0;
  G(1, 1) = 1.0;
  EXPECT_FALSE(stationary_cost(riccati_flow(A, G, MatrixXd::Identity(2, 2), 2e-3)));
  A(0, 0) = 0.0;  // it neither grows nor dies away
  EXPECT_FALSE(stationary_cost(riccati_flow(A, G, MatrixXd::Identity(2, 2), 2e-3)));
  A(0, 0) = -1.0;
  EXPECT_TRUE(stationary_cost(riccati_flow(A, G, MatrixXd::Identity(2, 2), 2e-3)));
}

}  // namespace
}  // namespace prowl
