#include "prowl/tracking/rollout_measures.hpp"

#include <gtest/gtest.h>

#include "prowl/model/configuration.hpp"
#include "tests/simulation/standing_tracker.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// HyQ stands on a slope of 10 degrees; the samples are made up, so that everything about them is known.
class RolloutMeasuresOfStanding : public testing::Test {
 protected:
  RolloutSample sample(double time) const {
    RolloutSample at{
        time, problem_.start_configuration(), VectorXd::Zero(robot().nv()), VectorXd::Zero(robot().nu()), {}, 0};
    at.force.resize(12);
    for (int c = 0; c < 4; ++c) at.force.segment<3>(3 * c) = 200.0 * normal();
    return at;
  }
  const RobotModel& robot() const { return problem_.robot; }
  const Eigen::Vector3d& normal() const { return problem_.surfaces.front().normal; }
  RolloutMeasures measure(const Rollout& rollout, std::optional<double> friction = {}) const {
    return measure_rollout(problem_, tracker_, rollout, 1.0, friction);
  }

  MotionProblem problem_ = test::standing_problem(test::hyq(), 10.0);
  Tracker tracker_ = test::standing_tracker(problem_);
};

TEST_F(RolloutMeasuresOfStanding, TellsErrorsOnTheWayAndInRest) {
  const double largest[] = {0.03, 0.01, 0.004, 0.002};
  Rollout rollout;
  for (int i = 0; i < 4; ++i) {
    RolloutSample at = sample(i == 0 ? 0.0 : 0.775 + 0.075 * i);  // 0, 0.85, 0.925, 1: the last three are in rest
    VectorXd move = VectorXd::Zero(robot().nv());
    move(1) = largest[i];
    move(4) = -2.0 * largest[i];
    move(9) = 3.0 * largest[i];
    at.q = integrate(at.q, move);
    rollout.samples.push_back(at);
  }
  const RolloutMeasures measures = measure(rollout);
  const double rms = std::sqrt((9e-4 + 1e-4 + 16e-6 + 4e-6) / 4.0);
  EXPECT_NEAR(measures.base_position.largest, 0.03, 1e-12);
  EXPECT_NEAR(measures.base_position.rest, 0.01, 1e-12);
  EXPECT_NEAR(measures.base_position.rms, rms, 1e-12);
  EXPECT_NEAR(measures.base_angle.largest, 0.06, 1e-12);
  EXPECT_NEAR(measures.base_angle.rest, 0.02, 1e-12);
  EXPECT_NEAR(measures.joints.largest, 0.09, 1e-12);
  EXPECT_NEAR(measures.joints.rms, 3.0 * rms / std::sqrt(12.0), 1e-12) << "one of twelve joints";
}

// Along the normal of the slope, not along the vertical.
TEST_F(RolloutMeasuresOfStanding, TellsWhenContactsPullOrSlip) {
  Rollout rollout{.samples = {sample(0.0), sample(0.5), sample(1.0)}};
  const Eigen::Vector3d along = problem_.surfaces.front().axes().col(0);
  rollout.samples[1].force.segment<3>(0) = -5.0 * normal() + 3.0 * along;    // pulls
  rollout.samples[2].force.segment<3>(3) = 100.0 * normal() + 62.0 * along;  // slips at a coefficient of 0.5
  const RolloutMeasures measures = measure(rollout);
  ASSERT_EQ(measures.contacts.size(), 4u);
  EXPECT_NEAR(measures.contacts[0].least_normal_force, -5.0, 1e-9);
  EXPECT_EQ(measures.contacts[0].least_normal_time, 0.5);
  EXPECT_NEAR(measures.contacts[0].beyond_cone, 3.0, 1e-9) << "a pull leaves no room for friction";
  EXPECT_NEAR(measures.contacts[1].least_normal_force, 100.0, 1e-9);
  EXPECT_NEAR(measures.contacts[1].beyond_cone, 62.0 - 50.0, 1e-9);
  EXPECT_EQ(measures.contacts[1].beyond_cone_time, 1.0);
  EXPECT_NEAR(measures.contacts[2].least_normal_force, 200.0, 1e-9);
  EXPECT_NEAR(measures.contacts[2].beyond_cone, -100.0, 1e-9);
  EXPECT_NEAR(measure(rollout, 0.8).contacts[1].beyond_cone, 62.0 - 80.0, 1e-9) << "friction other than the surface's";
}

TEST_F(RolloutMeasuresOfStanding, LeavesOutContactsInTheAir) {
  std::erase_if(problem_.phases.front().contacts, [](const PhaseContact& held) { return held.contact == 2; });
  const RolloutMeasures measures = measure({.samples = {sample(0.0)}});
  EXPECT_TRUE(measures.contacts[1].stood);
  EXPECT_FALSE(measures.contacts[2].stood);
}

TEST_F(RolloutMeasuresOfStanding, TellsUseOfTorque) {
  Rollout rollout{.samples = {sample(0.0), sample(0.25), sample(0.75), sample(1.0)}};
  const double limit = robot().torque_upper(3, robot().nominal_configuration()(10), 0.0);
  rollout.samples[0].tau(3) = 0.5 * limit;
  rollout.samples[1].tau(3) = limit;
  rollout.samples[1].v(6 + 3) = 2.0;
  rollout.samples[2].tau(3) = -0.1 * limit;
  rollout.samples[2].v(6 + 3) = 2.0;  // brakes: no work
  const RolloutMeasures measures = measure(rollout);
  EXPECT_NEAR(measures.largest_torque_share, 1.0, 1e-12);
  EXPECT_EQ(measures.largest_torque_joint, robot().joint_names()[3]);
  EXPECT_EQ(measures.saturated, 0.25);
  EXPECT_NEAR(measures.positive_work, 0.5 * limit * 2.0, 1e-9);
}

}  // namespace
}  // namespace prowl
