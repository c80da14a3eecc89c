// A robot at rest on a slope of 15 degrees, by hand: forces straight up, each f, have f cos 15 along the tilted normal
// and f sin 15 along the slope, 0.26795 of it. The friction cone has to be the one of that normal, for the planner and
// for the certificate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "prowl/certificate/certificate.hpp"
#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/guess/initial_guess.hpp"
#include "prowl/transcription/transcription.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

using Eigen::Vector4d;
using Eigen::VectorXd;

constexpr double kSin = 0.2588190451, kCos = 0.9659258263;

class OnASlope : public testing::Test {
 protected:
  /// Sets the vertical forces of least norm that carry the weight, and the torques that go with them, at all nodes.
  OnASlope() : problem_(test::standing_problem(test::hyq(), 15.0)) {
    const VectorXd& q = problem_.start_configuration();
    const VectorXd rest = VectorXd::Zero(problem_.robot.nv());
    RigidBodyTerms terms(problem_.robot);
    terms.update(q, rest, rest);
    ContactKinematics kinematics({0, 1, 2, 3});
    kinematics.set_configuration(terms);
    Eigen::Matrix<double, 12, 4> up = Eigen::Matrix<double, 12, 4>::Zero();
    for (int foot = 0; foot < 4; ++foot) up(3 * foot + 2, foot) = 1.0;
    const Eigen::Matrix<double, 6, 4> on_base = kinematics.jacobian().leftCols(6).transpose() * up;
    const VectorXd& gravity = terms.inverse_dynamics();
    forces_ = on_base.completeOrthogonalDecomposition().solve(gravity.head(6));
    EXPECT_LT((on_base * forces_ - gravity.head(6)).norm(), 1e-6);

    motion_ = initial_guess(on_slope(0.5));
    for (TrajectoryPoint& point : motion_.nodes) {
      point.q = q;
      point.v = point.a = rest;
      point.force = up * forces_;
      point.tau = gravity.tail(12) - kinematics.jacobian().rightCols(12).transpose() * point.force;
    }
  }

  DiscreteProblem on_slope(double friction) {
    problem_.surfaces[0].friction = friction;
    return test::on_even_mesh(problem_, 8);
  }

  /// Rows of the friction cones at the first node, in newtons.
  Vector4d cone_rows(double friction) {
    const DiscreteProblem discrete = on_slope(friction);
    Transcription nlp(discrete, motion_);
    VectorXd g(nlp.num_constraints());
    nlp.constraints(nlp.pack(motion_), g);
    EXPECT_LT(g.head(problem_.robot.nv()).cwiseAbs().maxCoeff(), 1e-9) << "at rest, with these torques";
    Vector4d rows;
    for (int foot = 0; foot < 4; ++foot) {
      const int row = problem_.robot.nv() + foot;
      EXPECT_THAT(nlp.describe_constraint(row), testing::HasSubstr("friction cone"));
      EXPECT_EQ(nlp.constraint_lower()(row), 0.0);
      rows(foot) = g(row) * problem_.robot.weight();
    }
    return rows;
  }

  CertificateCheck certified_friction(double friction) {
    for (const CertificateCheck& check : certify(on_slope(friction), motion_).checks) {
      if (check.name == "friction cone") return check;
    }
    ADD_FAILURE() << "no such check";
    return {};
  }

  MotionProblem problem_;
  Trajectory motion_;
  Vector4d forces_;
};

TEST_F(OnASlope, TheForcesAreTheWeight) {
  EXPECT_NEAR(forces_.sum(), problem_.robot.weight(), 1e-6);
  EXPECT_GT(forces_.minCoeff(), 0.1 * problem_.robot.weight());
}

TEST_F(OnASlope, ThePlannersConeIsTheOneOfTheTiltedNormal) {
  const double smoothing = 0.01 * problem_.robot.weight();
  for (const double friction : {0.5, 0.26}) {
    const Vector4d rows = cone_rows(friction);
    for (int foot = 0; foot < 4; ++foot) {
      const double f = forces_(foot), by_hand = friction * kCos * f - std::hypot(kSin * f, smoothing);
      EXPECT_NEAR(rows(foot), by_hand, 1e-6 * f) << "friction " << friction;
    }
  }
  // 0.5 * 0.966 - 0.259 = 0.224 of the weight to spare, less the smoothing of the tip; 0.26 is short of 0.268.
  EXPECT_GT(cone_rows(0.5).minCoeff(), 0.0);
  EXPECT_NEAR(cone_rows(0.5).sum(), 0.2241 * problem_.robot.weight(), 0.01 * problem_.robot.weight());
  EXPECT_LT(cone_rows(0.26).maxCoeff(), 0.0);
}

TEST_F(OnASlope, TheCertificatesConeIsTheOneOfTheTiltedNormal) {
  const CertificateCheck enough = certified_friction(0.5);
  EXPECT_TRUE(enough.passed);
  EXPECT_NEAR(enough.worst, (kSin - 0.5 * kCos) * forces_.minCoeff(), 1e-6 * problem_.robot.weight());
  const CertificateCheck short_of_it = certified_friction(0.26);
  EXPECT_NEAR(short_of_it.worst, (kSin - 0.26 * kCos) * forces_.maxCoeff(), 1e-6 * problem_.robot.weight());
  EXPECT_GT(short_of_it.worst, 0.0);
  EXPECT_FALSE(certified_friction(0.2).passed) << "by more than the tolerance of 1 % of the weight";
}

}  // namespace
}  // namespace prowl
