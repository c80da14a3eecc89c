#include "prowl/dynamics/projector.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <random>

#include "prowl/error.hpp"
#include "tests/support/random_vector.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

struct Shape {
  Eigen::Index rows, cols, rank;
};

/// None, one foot, four feet, four feet of which one depends on the others, two soles, more rows than columns, J = 0.
const std::vector<Shape> kShapes = {{0, 18, 0},   {3, 18, 3},   {12, 18, 12}, {12, 18, 11},
                                    {24, 38, 12}, {24, 18, 18}, {24, 18, 7},  {6, 18, 0}};

MatrixXd random_jacobian(const Shape& shape, std::mt19937& random) {
  return test::random_matrix(random, shape.rows, shape.rank) * test::random_matrix(random, shape.rank, shape.cols);
}

TEST(Projector, FindsTheRankAndThePseudoInverse) {
  std::mt19937 random(1);
  Projector projector;  // one for all shapes: nothing is left of the one before
  for (int repetition = 0; repetition < 20; ++repetition) {
    for (const Shape& shape : kShapes) {
      const MatrixXd J = random_jacobian(shape, random);
      projector.compute(J);
      EXPECT_EQ(projector.rank(), shape.rank);
      EXPECT_EQ(projector.full_rank(), shape.rank == shape.rows);

      // The four conditions of Moore and Penrose, which no other matrix fulfils.
      const MatrixXd X = projector.pseudo_inverse();
      ASSERT_EQ(X.rows(), shape.cols);
      ASSERT_EQ(X.cols(), shape.rows);
      const double tolerance = 1e-11;
      EXPECT_LE((J * X * J - J).norm(), tolerance * (1.0 + J.norm()));
      EXPECT_LE((X * J * X - X).norm(), tolerance * (1.0 + X.norm()));
      EXPECT_LE((J * X - (J * X).transpose()).norm(), tolerance);
      EXPECT_LE((X * J - (X * J).transpose()).norm(), tolerance);
      EXPECT_LE((projector.gram_inverse() - X.transpose() * X).norm(), tolerance * (1.0 + X.squaredNorm()));
    }
  }
}

TEST(Projector, ProjectsOnTheNullSpaceOfJ) {
  std::mt19937 random(2);
  Projector projector;
  for (const Shape& shape : kShapes) {
    const MatrixXd J = random_jacobian(shape, random);
    projector.compute(J);
    const MatrixXd P = projector.matrix();
    EXPECT_LE((P - P.transpose()).norm(), 1e-14);
    EXPECT_LE((P * P - P).norm(), 1e-13);
    EXPECT_LE((J * P).norm(), 1e-13 * (1.0 + J.norm()));
    EXPECT_NEAR(P.trace(), static_cast<double>(shape.cols - shape.rank), 1e-12);  // nothing else is taken away
  }
}

TEST(Projector, SolvesForTheLeastNormWithTheGramInverse) {
  std::mt19937 random(3);
  Projector projector;
  const MatrixXd J = random_jacobian({24, 18, 7}, random);
  projector.compute(J);
  const MatrixXd gram = J * J.transpose();
  const Eigen::JacobiSVD<MatrixXd> svd(gram, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const MatrixXd U = svd.matrixU().leftCols(7);
  const MatrixXd expected = U * svd.singularValues().head(7).cwiseInverse().asDiagonal() * U.transpose();
  EXPECT_LE((projector.gram_inverse() - expected).norm(), 1e-10 * expected.norm());
}

/// J of two points of one free body, a distance d apart: three rows of the first point say the same as the other three,
/// but for two rotations that move the second only, by d. Rank 5 (the distance is kept by itself).
MatrixXd two_points_of_one_body(double d) {
  const auto rows = [](const Vector3d& p) {
    MatrixXd J(3, 6);
    J << 1, 0, 0, 0, p.z(), -p.y(),  //
        0, 1, 0, -p.z(), 0, p.x(),   //
        0, 0, 1, p.y(), -p.x(), 0;
    return J;
  };
  MatrixXd J(6, 6);
  J << rows({0.3, 0.2, -0.5}), rows({0.3 + d, 0.2, -0.5});
  return J;
}

TEST(Projector, TellsNearPointsFromOnePoint) {
  Projector projector;
  const auto rank = [&](double d) {
    projector.compute(two_points_of_one_body(d));
    return projector.rank();
  };
  EXPECT_EQ(rank(0.1), 5);
  EXPECT_EQ(rank(1e-4), 5);
  EXPECT_EQ(rank(1e-7), 5);
  EXPECT_EQ(rank(1e-9), 3);
  EXPECT_EQ(rank(1e-12), 3);
  EXPECT_EQ(rank(0.0), 3);
}

TEST(Projector, PivotRatioFollowsTheSingularValues) {
  std::mt19937 random(4);
  Projector projector;
  for (double shrink = 1.0; shrink > 1e-7; shrink /= 10.0) {
    MatrixXd J = test::random_matrix(random, 12, 18);
    J.row(11) = J.row(3) + shrink * J.row(11);
    projector.compute(J);
    const Eigen::VectorXd sigma = Eigen::JacobiSVD<MatrixXd>(J).singularValues();
    EXPECT_LT(std::abs(std::log10(projector.pivot_ratio() / (sigma(11) / sigma(0)))), 1.0);
  }
}

TEST(Projector, RefusesWhatIsNotANumber) {
  Projector projector;
  MatrixXd J = MatrixXd::Identity(3, 18);
  J(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(projector.compute(J), NumericalError);
}

}  // namespace
}  // namespace prowl
