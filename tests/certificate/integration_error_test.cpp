#include "prowl/certificate/integration_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "prowl/certificate/reintegration.hpp"
#include "tests/certificate/stance_motion.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

/// A crouch of HyQ that also leans and turns: every coordinate moves.
test::StanceMotion crouch() { return {test::hyq(), 2.0, {0.05, 0.03, -0.10}, {0.06, 0.10, 0.08}}; }

PhaseDynamics dynamics_of(const test::StanceMotion& motion) {
  PhaseDynamics dynamics;
  dynamics.emplace_back(motion.robot(), motion.all_contacts());
  return dynamics;
}

double largest_error(test::StanceMotion& motion, const Trajectory& trajectory) {
  PhaseDynamics dynamics = dynamics_of(motion);
  double largest = 0.0;
  for (const IntervalError& interval : integration_errors(motion.robot(), trajectory, dynamics).intervals) {
    largest = std::max(largest, interval.error);
  }
  return largest;
}

TEST(IntegrationError, FallsWithTheCubeOfTheStep) {
  test::StanceMotion motion = crouch();
  const double coarse = largest_error(motion, motion.on_mesh(40));
  const double middle = largest_error(motion, motion.on_mesh(80));
  const double fine = largest_error(motion, motion.on_mesh(160));
  RecordProperty("error_40_intervals", std::to_string(coarse));
  EXPECT_GT(coarse / middle, 6.5);
  EXPECT_GT(middle / fine, 6.5);
  EXPECT_GT(fine, 1e-9) << "at rounding there is no order to see";
}

TEST(IntegrationError, IsOneValueAnIntervalAndSeesTheWrongOne) {
  test::StanceMotion motion = crouch();
  Trajectory trajectory = motion.on_mesh(20);
  const double clean = largest_error(motion, trajectory);
  trajectory.nodes[7].tau(4) += 20.0;  // [N m]
  PhaseDynamics dynamics = dynamics_of(motion);
  const auto errors = integration_errors(motion.robot(), trajectory, dynamics).intervals;
  ASSERT_EQ(errors.size(), 20u);
  for (std::size_t k = 0; k < errors.size(); ++k) {
    EXPECT_NEAR(errors[k].start, 0.1 * static_cast<double>(k), 1e-12);
    EXPECT_NEAR(errors[k].end - errors[k].start, 0.1, 1e-12);
    EXPECT_EQ(errors[k].error > 2.0 * clean, k == 6 || k == 7) << "interval " << k;
  }
}

/// Of a robot that stands still, with the torque at these nodes wrong: 20 intervals of 0.1 s.
double error_in_a_second(const std::vector<std::size_t>& wrong) {
  test::StanceMotion motion(test::hyq(), 2.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  Trajectory trajectory = motion.on_mesh(20);
  for (const std::size_t node : wrong) trajectory.nodes[node].tau(4) += 20.0;  // [N m]
  PhaseDynamics dynamics = dynamics_of(motion);
  return integration_errors(motion.robot(), trajectory, dynamics).checks.at(1).worst;
}

TEST(IntegrationError, AddsUpOverASecond) {
  const double one = error_in_a_second({2});
  EXPECT_GT(one, 1e-4);
  EXPECT_NEAR(error_in_a_second({2, 9}), 2.0 * one, 1e-6 * one) << "0.9 s from the first wrong interval to the last";
  EXPECT_NEAR(error_in_a_second({2, 11}), 1.5 * one, 0.1 * one) << "three of the four intervals are within a second";
  EXPECT_NEAR(error_in_a_second({2, 17}), one, 1e-6 * one);
}

TEST(Reintegration, FollowsAnExactMotionBetterOnAFinerMesh) {
  test::StanceMotion motion = crouch();
  PhaseDynamics dynamics = dynamics_of(motion);
  const double coarse = reintegration_errors(motion.robot(), motion.on_mesh(40), dynamics).check.worst;
  const double fine = reintegration_errors(motion.robot(), motion.on_mesh(80), dynamics).check.worst;
  EXPECT_GT(coarse, 1e-9);
  EXPECT_GT(coarse / fine, 6.5);  // the torque is linear inside an interval: O(h³)
}

TEST(Reintegration, IsNotFiniteRatherThanEndlessWhenTheMotionBlowsUp) {
  test::StanceMotion motion = crouch();
  Trajectory trajectory = motion.on_mesh(2);
  for (TrajectoryPoint& node : trajectory.nodes) node.tau.setConstant(1e12);
  PhaseDynamics dynamics = dynamics_of(motion);
  EXPECT_FALSE(reintegration_errors(motion.robot(), trajectory, dynamics).check.passed);
}

}  // namespace
}  // namespace prowl
