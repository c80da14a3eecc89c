// The recursion against the whole system as one dense matrix, in extended precision.
#include "prowl/solvers/riccati/stage_kkt.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "tests/solvers/random_chain.hpp"

namespace prowl {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::random_vector;
using test::RandomChain;
using Hessian = StageKkt::Hessian;
using Outcome = StageKkt::Outcome;
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Vector<long double, Eigen::Dynamic>;

/// Right sides and weights, a vector a stage.
struct System {
  StageVectors gradient, equalities, links, weights;
};

System random_system(std::mt19937& rng, const RandomChain& chain, double decades_of_weights) {
  System system;
  for (const RandomChain::Part& part : chain.parts) {
    system.gradient.push_back(random_vector(rng, part.size.variables(), 1.0));
    system.equalities.push_back(random_vector(rng, part.size.equalities, 1.0));
    system.links.push_back(random_vector(rng, part.slopes.next.rows(), 1.0));
    const VectorXd exponents = random_vector(rng, part.size.inequalities, 0.5 * decades_of_weights);
    system.weights.push_back(exponents.unaryExpr([](double e) { return std::pow(10.0, e); }));
  }
  return system;
}

VectorXd stacked(const StageVectors& parts) {
  Index size = 0;
  for (const VectorXd& part : parts) size += part.size();
  VectorXd all(size);
  Index at = 0;
  for (const VectorXd& part : parts) {
    all.segment(at, part.size()) = part;
    at += part.size();
  }
  return all;
}

/// M and the rows of all constraints, links first.
struct Dense {
  LongMatrix M, rows;
  LongVector gradient, right;

  Dense(const RandomChain& chain, Hessian hessian, double delta, const System& system) {
    Index variables = 0, links = 0, equalities = 0;
    for (const RandomChain::Part& part : chain.parts) {
      variables += part.size.variables();
      links += part.slopes.next.rows();
      equalities += part.size.equalities;
    }
    M.setZero(variables, variables);
    rows.setZero(links + equalities, variables);
    Index column = 0, link = 0, equality = links;
    for (std::size_t k = 0; k < chain.parts.size(); ++k) {
      const auto& [size, slopes, lagrangian] = chain.parts[k];
      const Index n = size.variables();
      const LongMatrix inequalities = slopes.inequalities.cast<long double>();
      LongMatrix block = inequalities.transpose() * system.weights[k].cast<long double>().asDiagonal() * inequalities;
      if (hessian == Hessian::lagrangian) block += lagrangian.cast<long double>();
      block.diagonal().array() += delta;
      M.block(column, column, n, n) = block;
      rows.block(equality, column, size.equalities, n) = slopes.equalities.cast<long double>();
      equality += size.equalities;
      const Index next = slopes.next.rows();
      rows.block(link, column, next, n) = slopes.next.cast<long double>();
      column += n;
      if (next > 0) {
        const Index inputs = chain.parts[k + 1].size.inputs;
        rows.block(link, column + inputs, next, next) -= LongMatrix::Identity(next, next);
      }
      link += next;
    }
    if (chain.closing.rows() > 0)
      rows.bottomLeftCorner(chain.closing.rows(), chain.closing.cols()) += chain.closing.cast<long double>();
    gradient = stacked(system.gradient).cast<long double>();
    right.resize(rows.rows());
    right << stacked(system.links).cast<long double>(), stacked(system.equalities).cast<long double>();
  }

  /// (steps | multipliers of links | of equalities)
  VectorXd solution() const {
    const Index n = M.rows(), m = rows.rows();
    LongMatrix all = LongMatrix::Zero(n + m, n + m);
    all << M, rows.transpose(), rows, LongMatrix::Zero(m, m);
    LongVector sides(n + m);
    sides << -gradient, -right;
    return Eigen::FullPivLU<LongMatrix>(all).solve(sides).cast<double>();
  }

  /// Least eigenvalue of M on the steps that keep the constraints, which must not depend on each other.
  double least_curvature() const {
    const MatrixXd columns = rows.transpose().cast<double>();
    const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(columns).householderQ();
    const MatrixXd Z = Q.rightCols(columns.rows() - columns.cols());
    return Eigen::SelfAdjointEigenSolver<MatrixXd>(Z.transpose() * M.cast<double>() * Z).eigenvalues()(0);
  }
};

VectorXd steps_of(const StageKkt& kkt) { return stacked(kkt.steps()); }

/// What the recursion leaves of the whole system, as a part of its right sides.
double residual(const StageKkt& kkt, const Dense& dense) {
  const LongVector steps = steps_of(kkt).cast<long double>();
  LongVector multipliers(dense.rows.rows());
  multipliers << stacked(kkt.on_next()).cast<long double>(), stacked(kkt.on_equalities()).cast<long double>();
  const LongVector dual = dense.M * steps + dense.rows.transpose() * multipliers + dense.gradient;
  const LongVector primal = dense.rows * steps + dense.right;
  return static_cast<double>(std::max(dual.cwiseAbs().maxCoeff(), primal.cwiseAbs().maxCoeff()));
}

constexpr double kNotRefined = std::numeric_limits<double>::infinity();  // as accuracy: the factors alone

void expect_dense_solution(RandomChain& chain, Hessian hessian, double delta, const System& system, double tolerance,
                           const std::string& what, const std::vector<double>& accuracies = {kNotRefined, 0.0}) {
  chain.linearise_all();
  StageKkt kkt(chain);
  kkt.determine_inputs();
  ASSERT_EQ(kkt.factorise(hessian, delta, system.weights), Outcome::solvable) << what;
  const Dense dense(chain, hessian, delta, system);
  const VectorXd expected = dense.solution();
  const Index n = dense.M.rows();
  EXPECT_GT(expected.head(n).norm(), 1e-3) << what << ": nothing moves";
  for (const double accuracy : accuracies) {
    kkt.solve(system.gradient, system.equalities, system.links, accuracy);
    VectorXd multipliers(dense.rows.rows());
    multipliers << stacked(kkt.on_next()), stacked(kkt.on_equalities());
    EXPECT_LT(test::relative_error(steps_of(kkt), expected.head(n)), tolerance) << what;
    EXPECT_LT(test::relative_error(multipliers, expected.tail(multipliers.size())), tolerance) << what;
    for (std::size_t k = 0; k < chain.parts.size(); ++k) {
      const VectorXd along = chain.parts[k].slopes.inequalities * kkt.steps()[k];
      EXPECT_LT(test::relative_error(kkt.along_inequalities()[k], along), 1e-12) << what;
    }
  }
}

// Sizes: inputs, states, equalities, inequalities.
const std::vector<StageSize> kFree = {{3, 0, 0, 2}, {4, 3, 0, 3}, {2, 5, 0, 0}, {3, 2, 0, 4}, {0, 4, 0, 2}};
const std::vector<StageSize> kEqualities = {{4, 0, 1, 2}, {4, 3, 2, 5}, {5, 4, 1, 0},
                                            {3, 2, 3, 4}, {2, 4, 0, 1}, {0, 2, 0, 3}};
/// The last two stages have more equalities than inputs: what is left goes back over several stages of one input each.
const std::vector<StageSize> kPassed = {{2, 0, 0, 1}, {1, 4, 0, 1}, {1, 4, 0, 2}, {1, 4, 0, 0},
                                        {1, 4, 0, 1}, {1, 4, 2, 1}, {0, 4, 3, 2}};
/// Larger than the blocks in which Eigen factorises.
const std::vector<StageSize> kLarge = {{40, 0, 18, 60}, {40, 30, 18, 60}, {40, 36, 22, 70}, {0, 36, 6, 30}};

TEST(StageKkt, IsTheDenseSolution) {
  std::mt19937 rng(3);
  const std::vector<std::pair<std::string, std::vector<StageSize>>> cases = {
      {"free", kFree},
      {"equalities", kEqualities},
      {"passed", kPassed},
      {"large", kLarge},
      {"one stage", {{3, 0, 1, 2}}},
      {"states at first", {{2, 3, 1, 1}, {2, 3, 1, 2}, {0, 2, 1, 0}}}};
  for (const auto& [name, sizes] : cases) {
    for (int repeat = 0; repeat < (name == "large" ? 1 : 20); ++repeat) {
      RandomChain chain(rng, sizes);
      const System system = random_system(rng, chain, 2.0);
      for (const double delta : {0.0, 3.0}) {
        expect_dense_solution(chain, Hessian::lagrangian, delta, system, 1e-8, name);
      }
      expect_dense_solution(chain, Hessian::identity, 0.7, system, 1e-8, name + ", identity");
    }
  }
}

/// As a controller does that has prepared for another state: what changes in the first stages alone needs no others.
TEST(StageKkt, FirstStagesAreSolvedAnewBeforeTheSameRest) {
  std::mt19937 rng(37);
  for (const std::vector<StageSize>& sizes : {kFree, kEqualities, kPassed}) {
    const int stages = static_cast<int>(sizes.size());
    for (int first = 1; first <= stages; ++first) {
      RandomChain chain(rng, sizes);
      System system = random_system(rng, chain, 2.0);
      chain.linearise_all();
      StageKkt kkt(chain);
      kkt.determine_inputs();
      ASSERT_EQ(kkt.factorise(Hessian::lagrangian, 0.3, system.weights), Outcome::solvable);
      kkt.sweep_back(stages, system.gradient, system.equalities, system.links);

      for (int iteration = 0; iteration < 2; ++iteration) {
        const System other = random_system(rng, chain, 2.0);
        for (int k = 0; k < first; ++k) {
          system.gradient[k] = other.gradient[k];
          system.weights[k] = other.weights[k];
        }
        ASSERT_EQ(kkt.factorise_first(first, Hessian::lagrangian, 0.3, system.weights), Outcome::solvable);
        kkt.sweep_back(first, system.gradient, system.equalities, system.links);
        kkt.sweep_ahead(0, first, system.links);
      }
      kkt.sweep_ahead(first, stages, system.links);
      StageKkt whole(chain);
      whole.determine_inputs();
      ASSERT_EQ(whole.factorise(Hessian::lagrangian, 0.3, system.weights), Outcome::solvable);
      whole.solve(system.gradient, system.equalities, system.links, kNotRefined);
      EXPECT_EQ(steps_of(kkt), steps_of(whole)) << first;
      EXPECT_EQ(stacked(kkt.on_next()), stacked(whole.on_next())) << first;
      EXPECT_EQ(stacked(kkt.on_equalities()), stacked(whole.on_equalities())) << first;
    }
  }
}

/// The last equalities of the last stage are also ones of the first.
TEST(StageKkt, ClosesAChain) {
  std::mt19937 rng(23);
  const int closing = 3;
  for (const std::vector<StageSize>& sizes :
       {std::vector<StageSize>{{6, 0, 1, 2}, {4, 3, 2, 2}, {3, 4, 1, 1}, {1, 4, 1 + closing, 2}},
        std::vector<StageSize>{{5, 0, 0, 1}, {4, 3, 2, 2}, {0, 4, closing, 0}}}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      RandomChain chain(rng, sizes);
      chain.closing = test::random_matrix(rng, closing, sizes.front().variables());
      const System system = random_system(rng, chain, 2.0);
      expect_dense_solution(chain, Hessian::lagrangian, 0.3, system, 1e-8, "closed");
      expect_dense_solution(chain, Hessian::identity, 0.7, system, 1e-8, "closed, identity");
    }
  }
}

/// Closing equalities may exclude the directions along which the open chain bends down, or may not.
TEST(StageKkt, KnowsWhetherAClosedChainHasAMinimum) {
  std::mt19937 rng(29);
  int solvable = 0, indefinite = 0;
  for (int repeat = 0; repeat < 200; ++repeat) {
    RandomChain chain(rng, {{5, 0, 0, 0}, {3, 3, 1, 0}, {2, 3, 1, 0}, {1, 3, 3, 0}});
    chain.closing = test::random_matrix(rng, 3, 5);
    for (RandomChain::Part& part : chain.parts)
      part.hessian -= 0.5 * MatrixXd::Identity(part.hessian.rows(), part.hessian.rows());
    const System system = random_system(rng, chain, 0.0);
    chain.linearise_all();
    StageKkt kkt(chain);
    kkt.determine_inputs();
    const bool has_minimum = Dense(chain, Hessian::lagrangian, 0.0, system).least_curvature() > 0.0;
    EXPECT_EQ(kkt.factorise(Hessian::lagrangian, 0.0, system.weights) == Outcome::solvable, has_minimum);
    ++(has_minimum ? solvable : indefinite);
  }
  EXPECT_GT(solvable, 20);
  EXPECT_GT(indefinite, 20);
}

TEST(StageKkt, PivotsFullyOnlyWhereTheFirstInputsDoNotServe) {
  std::mt19937 rng(13);
  RandomChain chain(rng, {{4, 0, 2, 1}, {5, 4, 2, 1}, {4, 3, 2, 1}, {3, 3, 2, 1}, {0, 2, 0, 1}});
  const System system = random_system(rng, chain, 2.0);
  const auto pivoted = [&] {
    chain.linearise_all();
    StageKkt kkt(chain);
    kkt.determine_inputs();
    EXPECT_EQ(kkt.factorise(Hessian::lagrangian, 0.0, system.weights), Outcome::solvable);
    return kkt.num_pivoted();
  };
  EXPECT_EQ(pivoted(), 0);
  chain.parts[1].slopes.equalities.col(0).setZero();
  EXPECT_EQ(pivoted(), 1) << "an input without a say";
  expect_dense_solution(chain, Hessian::lagrangian, 0.0, system, 1e-10, "another input is determined");
  chain.parts[2].slopes.equalities.leftCols(4).setZero();
  EXPECT_EQ(pivoted(), 1) << "conditions on states; the first inputs of the stage before meet them";
  expect_dense_solution(chain, Hessian::lagrangian, 0.0, system, 1e-10, "conditions are passed");
}

TEST(StageKkt, SolvesForNewRightSidesWithTheSameFactors) {
  std::mt19937 rng(4);
  RandomChain chain(rng, kPassed);
  chain.linearise_all();
  StageKkt kkt(chain);
  kkt.determine_inputs();
  const System first = random_system(rng, chain, 2.0);
  System second = random_system(rng, chain, 2.0);
  second.weights = first.weights;
  ASSERT_EQ(kkt.factorise(Hessian::lagrangian, 0.0, first.weights), Outcome::solvable);
  kkt.solve(first.gradient, first.equalities, first.links);
  const VectorXd steps = steps_of(kkt);
  kkt.solve(second.gradient, second.equalities, second.links);
  EXPECT_LT(residual(kkt, Dense(chain, Hessian::lagrangian, 0.0, second)), 1e-9);
  EXPECT_GT((steps_of(kkt) - steps).norm(), 0.1);
  kkt.solve(first.gradient, first.equalities, first.links);
  EXPECT_EQ(steps_of(kkt), steps);
}

TEST(StageKkt, KeepsDeterminedInputsBetweenFactorisations) {
  std::mt19937 rng(14);
  for (const auto& sizes : {kEqualities, kPassed}) {
    RandomChain chain(rng, sizes);
    chain.linearise_all();
    const System system = random_system(rng, chain, 2.0);
    const auto steps_of_last = [&](const std::vector<std::pair<Hessian, double>>& factorisations) {
      StageKkt kkt(chain);
      kkt.determine_inputs();
      for (const auto& [hessian, delta] : factorisations) {
        EXPECT_EQ(kkt.factorise(hessian, delta, system.weights), Outcome::solvable);
      }
      kkt.solve(system.gradient, system.equalities, system.links);
      return steps_of(kkt);
    };
    const VectorXd steps = steps_of_last({{Hessian::lagrangian, 0.0}});
    EXPECT_EQ(steps_of_last({{Hessian::identity, 0.7}, {Hessian::lagrangian, 3.0}, {Hessian::lagrangian, 0.0}}), steps);
    EXPECT_GT((steps_of_last({{Hessian::lagrangian, 3.0}}) - steps).norm(), 1e-2);
  }
}

/// As near the end of an interior point method: inequalities that hold tight, and others that do not matter.
TEST(StageKkt, TakesWeightsOfAllSizes) {
  std::mt19937 rng(5);
  for (const auto& sizes : {kFree, kEqualities, kPassed}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      RandomChain chain(rng, sizes);
      for (RandomChain::Part& part : chain.parts) {  // at most as many tight ones as variables
        part.slopes.inequalities.setZero();
        for (Index i = 0; i < std::min<Index>(part.slopes.inequalities.rows(), part.size.variables()); ++i) {
          part.slopes.inequalities(i, i) = 1.0;
        }
      }
      const System system = random_system(rng, chain, 12.0);
      chain.linearise_all();
      StageKkt kkt(chain);
      kkt.determine_inputs();
      ASSERT_EQ(kkt.factorise(Hessian::lagrangian, 0.0, system.weights), Outcome::solvable);
      kkt.solve(system.gradient, system.equalities, system.links);
      const VectorXd expected = Dense(chain, Hessian::lagrangian, 0.0, system).solution();
      EXPECT_LT(test::relative_error(steps_of(kkt), expected.head(steps_of(kkt).size())), 1e-7);
    }
  }
}

TEST(StageKkt, TakesFunctionsOfAllScales) {
  std::mt19937 rng(6);
  const auto scaling = [&](Index size, double decades) -> VectorXd {
    return random_vector(rng, size, 0.5 * decades).unaryExpr([](double e) { return std::pow(10.0, e); });
  };
  for (int repeat = 0; repeat < 20; ++repeat) {
    RandomChain chain(rng, kEqualities);
    for (RandomChain::Part& part : chain.parts) {
      part.slopes.equalities = (scaling(part.size.equalities, 4.0).asDiagonal() * part.slopes.equalities).eval();
      const VectorXd curvature = scaling(part.size.variables(), 4.0);
      part.hessian = (curvature.asDiagonal() * part.hessian * curvature.asDiagonal()).eval();
    }
    const System system = random_system(rng, chain, 2.0);
    chain.linearise_all();
    StageKkt kkt(chain);
    kkt.determine_inputs();
    ASSERT_EQ(kkt.factorise(Hessian::lagrangian, 0.0, system.weights), Outcome::solvable);
    kkt.solve(system.gradient, system.equalities, system.links);
    const VectorXd expected = Dense(chain, Hessian::lagrangian, 0.0, system).solution();
    EXPECT_LT(test::relative_error(steps_of(kkt), expected.head(steps_of(kkt).size())), 1e-6);
  }
}

/// Equalities on states alone, early and late, of which the inputs before determine all.
TEST(StageKkt, PassesConditionsOnStatesBack) {
  std::mt19937 rng(7);
  for (int repeat = 0; repeat < 20; ++repeat) {
    RandomChain chain(rng, kPassed);
    for (RandomChain::Part& part : chain.parts) part.slopes.equalities.leftCols(part.size.inputs).setZero();
    expect_dense_solution(chain, Hessian::lagrangian, 0.0, random_system(rng, chain, 2.0), 1e-8, "on states");
  }
}

/// Rows that are sums of others, with right sides to match: in one stage, and between a stage and the next by its link.
TEST(StageKkt, LeavesOutEqualitiesThatDependOnOthers) {
  std::mt19937 rng(8);
  const std::vector<StageSize> sizes = {{5, 0, 2, 1}, {5, 4, 4, 2}, {2, 4, 3, 1}, {0, 4, 2, 1}};
  for (int repeat = 0; repeat < 20; ++repeat) {
    RandomChain chain(rng, sizes);
    System system = random_system(rng, chain, 2.0);
    StageDerivatives &second = chain.parts[1].slopes, &third = chain.parts[2].slopes;
    second.equalities.row(3) = second.equalities.row(0) - 2.0 * second.equalities.row(1);
    system.equalities[1](3) = system.equalities[1](0) - 2.0 * system.equalities[1](1);
    // Of the third's state only, and said already by the second's inputs and state.
    third.equalities.row(0).setZero();
    third.equalities(0, 2) = 1.0;
    second.equalities.row(2) = second.next.row(0);
    system.equalities[2](0) = 0.3;
    system.equalities[1](2) = 0.3 + system.links[1](0);

    chain.linearise_all();
    StageKkt kkt(chain);
    kkt.determine_inputs();
    ASSERT_EQ(kkt.factorise(Hessian::lagrangian, 0.0, system.weights), Outcome::solvable);
    kkt.solve(system.gradient, system.equalities, system.links);
    const Dense dense(chain, Hessian::lagrangian, 0.0, system);
    EXPECT_LT(residual(kkt, dense), 1e-8);
    const auto rank = Eigen::FullPivLU<LongMatrix>(dense.rows).setThreshold(1e-12L).rank();
    EXPECT_EQ(rank, dense.rows.rows() - 2) << "rows that do not depend on each other: nothing was tested";
  }
}

/// Two equalities on nearly the same inputs: what tells them apart in the inputs is a billionth, and the rest is a
/// condition on the state. Refinement takes the billionth into account.
TEST(StageKkt, RefinesWhereInputsBarelyTellEqualitiesApart) {
  std::mt19937 rng(9);
  for (int repeat = 0; repeat < 20; ++repeat) {
    RandomChain chain(rng, {{4, 0, 0, 1}, {4, 4, 0, 1}, {3, 4, 2, 2}, {0, 3, 0, 1}});
    RandomChain::Part& part = chain.parts[2];
    const VectorXd noise = 1e-9 * random_vector(rng, part.size.inputs, 1.0);
    part.slopes.equalities.row(1).head(part.size.inputs) =
        part.slopes.equalities.row(0).head(part.size.inputs) + noise.transpose();
    const System system = random_system(rng, chain, 2.0);
    expect_dense_solution(chain, Hessian::lagrangian, 0.0, system, 1e-10, "nearly dependent", {0.0});

    StageKkt kkt(chain);
    kkt.determine_inputs();
    ASSERT_EQ(kkt.factorise(Hessian::lagrangian, 0.0, system.weights), Outcome::solvable);
    EXPECT_EQ(kkt.num_pivoted(), 1);
    const Dense dense(chain, Hessian::lagrangian, 0.0, system);
    const auto residual_with = [&](double accuracy) {
      kkt.solve(system.gradient, system.equalities, system.links, accuracy);
      return residual(kkt, dense);
    };
    const double alone = residual_with(kNotRefined);
    EXPECT_GT(alone, 1e-11) << "nothing to refine";
    EXPECT_LE(residual_with(1e-2 * alone), 1e-2 * alone);
  }
}

TEST(StageKkt, IsSolvableIfAndOnlyIfTheReducedHessianIsPositive) {
  std::mt19937 rng(10);
  int counts[2] = {0, 0};
  for (const auto& sizes : {kFree, kEqualities, kPassed}) {
    for (int repeat = 0; repeat < 60; ++repeat) {
      RandomChain chain(rng, sizes);
      System system = random_system(rng, chain, 2.0);
      for (RandomChain::Part& part : chain.parts) {
        const MatrixXd noise = test::random_matrix(rng, part.size.variables(), part.size.variables());
        part.hessian += 0.5 * (noise + noise.transpose());
      }
      chain.linearise_all();
      const double least = Dense(chain, Hessian::lagrangian, 0.0, system).least_curvature();
      StageKkt kkt(chain);
      kkt.determine_inputs();
      for (const double delta : {0.0, -least + 1e-6, -least - 1e-6}) {
        const bool is_convex = least + delta > 0.0;
        ++counts[is_convex];
        EXPECT_EQ(kkt.factorise(Hessian::lagrangian, delta, system.weights),
                  is_convex ? Outcome::solvable : Outcome::indefinite)
            << least + delta;
      }
    }
  }
  EXPECT_GT(counts[0], 100);
  EXPECT_GT(counts[1], 100);
}

TEST(StageKkt, TellsWhatIsNotFinite) {
  std::mt19937 rng(11);
  for (const auto& sizes : {kEqualities, kPassed}) {
    RandomChain chain(rng, sizes);
    const System system = random_system(rng, chain, 2.0);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      for (std::size_t k = 0; k < chain.parts.size(); ++k) {
        const auto expect_not_finite = [&](MatrixXd& matrix, const char* what) {
          if (matrix.size() == 0) return;
          const MatrixXd good = matrix;
          matrix(matrix.rows() - 1, matrix.cols() / 2) = bad;
          chain.linearise_all();
          StageKkt kkt(chain);
          kkt.determine_inputs();
          EXPECT_EQ(kkt.factorise(Hessian::lagrangian, 0.0, system.weights), Outcome::not_finite)
              << what << ", stage " << k << ": " << bad;
          matrix = good;
        };
        RandomChain::Part& part = chain.parts[k];
        expect_not_finite(part.hessian, "Hessian");
        expect_not_finite(part.slopes.next, "next");
        expect_not_finite(part.slopes.equalities, "equalities");
        expect_not_finite(part.slopes.inequalities, "inequalities");
      }
    }
    chain.linearise_all();
    StageKkt kkt(chain);
    kkt.determine_inputs();
    EXPECT_EQ(kkt.factorise(Hessian::lagrangian, 0.0, system.weights), Outcome::solvable);
  }
}

// The states of the first stage are given: their step is kept, and the inputs follow by the gain.
TEST(StageKkt, InputsFollowAGivenStart) {
  std::mt19937 rng(31);
  RandomChain chain(rng, {{4, 3, 2, 5}, {5, 4, 1, 0}, {3, 2, 1, 4}, {2, 4, 0, 1}});
  const System system = random_system(rng, chain, 2.0);
  chain.linearise_all();
  StageKkt kkt(chain, StageKkt::Start::given);
  kkt.determine_inputs();
  ASSERT_EQ(kkt.factorise(Hessian::lagrangian, 0.0, system.weights), Outcome::solvable);
  kkt.solve(system.gradient, system.equalities, system.links, kNotRefined);
  const VectorXd at_zero = kkt.steps()[0];
  EXPECT_EQ(at_zero.tail(3).norm(), 0.0);
  const VectorXd start = random_vector(rng, 3, 1.0);
  kkt.set_states(0, start);
  kkt.solve(system.gradient, system.equalities, system.links, kNotRefined);
  const VectorXd moved = kkt.steps()[0];
  EXPECT_EQ(moved.tail(3), start);
  MatrixXd gain(4, 3);
  kkt.input_gain(0, gain);
  EXPECT_GT(gain.norm(), 1e-3);
  EXPECT_LT((moved.head(4) - at_zero.head(4) - gain * start).norm(), 1e-10 * (1.0 + gain.norm()));
  // Both satisfy the equalities and links of the first stage.
  const StageDerivatives& slopes = chain.parts[0].slopes;
  EXPECT_LT((slopes.equalities * moved + system.equalities[0]).norm(), 1e-10);
  EXPECT_LT((slopes.next * moved + system.links[0] - kkt.steps()[1].tail(4)).norm(), 1e-10);
}

}  // namespace
}  // namespace prowl
