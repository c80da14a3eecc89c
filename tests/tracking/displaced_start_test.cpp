#include "prowl/tracking/displaced_start.hpp"

#include <gtest/gtest.h>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "tests/simulation/standing_tracker.hpp"
#include "tests/support/random_vector.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;
using Vector6d = Eigen::Matrix<double, 6, 1>;

class DisplacedStart : public testing::Test {
 protected:
  std::vector<Eigen::Vector3d> feet(const VectorXd& q) const {
    RigidBodyTerms terms(problem_.robot);
    terms.update_kinematics(q);
    std::vector<Eigen::Vector3d> feet;
    for (int c = 0; c < 4; ++c) feet.push_back(terms.contact_position(c));
    return feet;
  }
  MotionProblem problem_ = test::standing_problem();
  TrackingPlan plan_ = test::standing_tracker(problem_).plan();
  const VectorXd& reference_ = problem_.start_configuration();
};

TEST_F(DisplacedStart, MovesTheBaseAndNoFoot) {
  std::mt19937 rng(3);
  for (int i = 0; i < 20; ++i) {
    const Vector6d displacement = test::random_vector(rng, 6, 0.03);
    const StartState start = displaced_start(problem_.robot, Tracker(plan_), displacement);
    EXPECT_LT((difference(reference_, start.q).head<6>() - displacement).norm(), 1e-12);
    EXPECT_GT(difference(reference_, start.q).tail(problem_.robot.nu()).norm(), 1e-3);
    for (int c = 0; c < 4; ++c) EXPECT_LT((feet(start.q)[c] - feet(reference_)[c]).norm(), 1e-8);
    EXPECT_TRUE(start.v.isZero(0.0)) << "it was at rest";
  }
}

TEST_F(DisplacedStart, IsTheReferenceWithoutDisplacement) {
  std::mt19937 rng(4);
  plan_.v = test::random_vector(rng, problem_.robot.nv(), 1.0).replicate(1, 2);
  const StartState start = displaced_start(problem_.robot, Tracker(plan_), Vector6d::Zero());
  EXPECT_EQ(start.q, plan_.q.col(0));
  EXPECT_EQ(start.v, plan_.v.col(0));
}

// A velocity that the plan starts with goes on as far as the feet allow at the new posture.
TEST_F(DisplacedStart, LeavesNoFootMoving) {
  std::mt19937 rng(5);
  plan_.v = test::random_vector(rng, problem_.robot.nv(), 1.0).replicate(1, 2);
  const StartState start = displaced_start(problem_.robot, Tracker(plan_), Vector6d::Constant(0.02));
  constexpr double kStep = 1e-6;  // [s]
  VectorXd step = kStep * start.v;
  step.head<3>() = base_rotation(start.q) * step.head<3>();
  EXPECT_GT(start.v.norm(), 0.1);
  for (int c = 0; c < 4; ++c) EXPECT_LT((feet(integrate(start.q, step))[c] - feet(start.q)[c]).norm() / kStep, 1e-5);
}

TEST_F(DisplacedStart, NeedsNoFeet) {
  plan_.segments.front().in_contact.assign(4, false);
  const Vector6d displacement = Vector6d::Constant(2.0);
  const StartState start = displaced_start(problem_.robot, Tracker(plan_), displacement);
  EXPECT_LT((start.q.head<3>() - reference_.head<3>() - displacement.head<3>()).norm(), 1e-12);
  EXPECT_EQ(start.q.tail(problem_.robot.nu()), reference_.tail(problem_.robot.nu()));
}

TEST_F(DisplacedStart, RefusesWhatTheLegsCannot) {
  const Tracker tracker(plan_);
  Vector6d displacement = Vector6d::Zero();
  displacement(2) = 1.0;
  EXPECT_THROW(displaced_start(problem_.robot, tracker, displacement), InputError);
  displacement(2) = std::nan("");
  EXPECT_THROW(displaced_start(problem_.robot, tracker, displacement), InputError);
}

}  // namespace
}  // namespace prowl
