#include "prowl/tracker/tracker.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/random_tracking_plan.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

VectorXd random_configuration(std::mt19937& rng, int joints) {
  VectorXd q = test::random_vector(rng, 7 + joints, 1.0);
  q.segment<4>(3).normalize();
  return q;
}

TrackingPlan without_limits(TrackingPlan plan) {
  plan.torque_limit.setConstant(kInfinity);
  plan.torque_curves.clear();
  return plan;
}

// The state difference is that of configuration.hpp, with which the gains are computed: x ⊖ x* and x* ⊖ x but for the
// sign.
TEST(Tracker, TakesTheDifferenceOfTheConfigurationSpace) {
  std::mt19937 rng(2);
  for (int i = 0; i < 1000; ++i) {
    const VectorXd q = random_configuration(rng, 12), q_to = random_configuration(rng, 12);
    VectorXd there(18), back(18);
    configuration_difference(q, q_to, there);
    configuration_difference(q_to, q, back);
    EXPECT_LT((there - difference(q, q_to)).norm(), 1e-11);
    EXPECT_LT((there + back).norm(), 1e-14);
  }
  const VectorXd q = random_configuration(rng, 12);
  VectorXd none(18), negated = q;
  negated.segment<4>(3) *= -1.0;
  configuration_difference(q, negated, none);
  EXPECT_LT(none.norm(), 1e-14) << "one rotation has two quaternions";
}

TEST(Tracker, GivesTheControlLawOnTheGrid) {
  const Tracker tracker(without_limits(test::random_tracking_plan()));
  const TrackingPlan& plan = tracker.plan();
  std::mt19937 rng(3);
  int checked = 0;
  for (const TrackingPlan::Segment& segment : plan.segments) {
    for (int i = 0; i + 1 < segment.samples; ++i) {  // the last of a segment is the first of the next
      const double t = segment.start + i * (segment.end - segment.start) / (segment.samples - 1);
      const int k = segment.first_sample + i;
      const VectorXd q = random_configuration(rng, plan.nu()), v = test::random_vector(rng, plan.nv(), 1.0);
      VectorXd error(2 * plan.nv());
      error << difference(q, plan.q.col(k)), plan.v.col(k) - v;
      const MatrixXd K = Eigen::Map<const MatrixXd>(plan.gains.col(k).data(), plan.nu(), 2 * plan.nv());
      const VectorXd expected = plan.tau.col(k) + K * error;
      VectorXd tau(plan.nu()), feedback(plan.nu()), feedforward(plan.nu());
      tracker.torque(t, q, v, tau);
      EXPECT_LT((tau - expected).norm(), 1e-9 * expected.norm());
      tracker.feedback(t, q, v, feedback);
      tracker.feedforward(t, feedforward);
      EXPECT_LT((feedback + feedforward - tau).norm(), 1e-12 * tau.norm());
      ++checked;
    }
  }
  EXPECT_EQ(checked, 30);
}

TEST(Tracker, IsLinearBetweenSamplesAndHoldsBothEnds) {
  const Tracker tracker(test::random_tracking_plan());
  const TrackingPlan& plan = tracker.plan();
  VectorXd q(plan.nq()), v(plan.nv()), tau(plan.nu());
  MatrixXd K(plan.nu(), 2 * plan.nv());

  const double t = 0.5 + 0.25 * 0.05;  // a quarter into the first interval of the second segment
  tracker.reference(t, q, v);
  const VectorXd q0 = plan.q.col(11), q1 = plan.q.col(12);
  EXPECT_LT((difference(q0, q) - 0.25 * difference(q0, q1)).norm(), 1e-9);
  EXPECT_LT((v - 0.75 * plan.v.col(11) - 0.25 * plan.v.col(12)).norm(), 1e-9);
  tracker.feedforward(t, tau);
  EXPECT_LT((tau - 0.75 * plan.tau.col(11) - 0.25 * plan.tau.col(12)).norm(), 1e-9);
  tracker.gains(t, K);
  EXPECT_LT((K.reshaped() - 0.75 * plan.gains.col(11) - 0.25 * plan.gains.col(12)).norm(), 1e-9);

  for (const auto& [time, sample] :
       {std::pair{-1.0, 0}, {-kInfinity, 0}, {0.0, 0}, {0.5, 11}, {1.5, 32}, {9.0, 32}, {kInfinity, 32}, {kNaN, 32}}) {
    tracker.reference(time, q, v);
    tracker.gains(time, K);
    EXPECT_LT((v - plan.v.col(sample)).norm(), 1e-12) << time;
    EXPECT_LT((K.reshaped() - plan.gains.col(sample)).norm(), 1e-12) << time;
  }
  EXPECT_EQ(tracker.segment(0.49).name, "phase 0");
  EXPECT_EQ(tracker.segment(0.5).name, "phase 1");
  EXPECT_FALSE(tracker.segment(0.7).in_contact[2]);
  EXPECT_EQ(tracker.segment(kNaN).name, "phase 2");
}

TEST(Tracker, StaysWithinTheTorqueLimits) {
  TrackingPlan plan = test::random_tracking_plan();
  plan.gains *= 1e4;
  const Tracker tracker(plan);
  std::mt19937 rng(4);
  int limited = 0, unlimited = 0, braking = 0, pulling = 0;
  for (int i = 0; i < 200; ++i) {
    VectorXd q = random_configuration(rng, plan.nu()), v = 2.0 * test::random_vector(rng, plan.nv(), 1.0),
             tau(plan.nu());
    q(7) = 0.5;  // of the curve over position: 70
    v(7) = 2.5;  // of the curve over velocity: 50 upwards, 105 downwards
    tracker.torque(0.01 * i, q, v, tau);
    limited += tau(2) == 150.0;
    pulling += tau(2) == -30.0;
    EXPECT_GE(tau(2), -30.0);
    unlimited += std::abs(tau(plan.nu() - 1)) > 150.0;
    for (int j = 0; j + 1 < plan.nu(); ++j) EXPECT_LE(std::abs(tau(j)), 150.0);
    EXPECT_LE(std::abs(tau(0)), 70.0 + 1e-9);
    EXPECT_LE(tau(1), 50.0 + 1e-9);
    EXPECT_GE(tau(1), -105.0 - 1e-9);
    braking += tau(1) < -104.0;
  }
  EXPECT_GT(limited, 50);
  EXPECT_GT(pulling, 50) << "as much as the curve of negative torques allows";
  EXPECT_GT(unlimited, 100);
  EXPECT_GT(braking, 50) << "as much as the curve allows downwards";
}

TEST(Tracker, GivesTheFeedforwardWhereTheStateIsNoState) {
  const Tracker tracker(without_limits(test::random_tracking_plan()));
  const TrackingPlan& plan = tracker.plan();
  std::mt19937 rng(5);
  const VectorXd good_q = random_configuration(rng, plan.nu()), good_v = test::random_vector(rng, plan.nv(), 1.0);
  VectorXd tau(plan.nu());
  for (int bad = 0; bad < 3; ++bad) {
    VectorXd q = good_q, v = good_v;
    if (bad == 0) q(9) = kNaN;
    if (bad == 1) v(0) = kInfinity;
    if (bad == 2) q.segment<4>(3).setZero();
    tracker.torque(0.0, q, v, tau);
    EXPECT_EQ((tau - plan.tau.col(0)).norm(), 0.0);
  }
  tracker.torque(0.0, good_q, good_v, tau);
  EXPECT_GT((tau - plan.tau.col(0)).norm(), 1.0);
  VectorXd longer = good_q, same(plan.nu());
  longer.segment<4>(3) *= 1.5;
  tracker.torque(0.0, longer, good_v, same);
  EXPECT_LT((tau - same).norm(), 1e-9 * tau.norm());
}

TEST(Tracker, RefusesPlansThatMakeNoSense) {
  const TrackingPlan good = test::random_tracking_plan();
  EXPECT_NO_THROW(Tracker{good});
  const std::vector<void (*)(TrackingPlan&)> faults = {
      [](TrackingPlan& p) { p.q(3, 5) = kNaN; },
      [](TrackingPlan& p) { p.gains(7, 5) = kInfinity; },
      [](TrackingPlan& p) { p.q.block<4, 1>(3, 4) *= 2.0; },
      [](TrackingPlan& p) { p.v.conservativeResize(17, p.v.cols()); },
      [](TrackingPlan& p) { p.segments.clear(); },
      [](TrackingPlan& p) { p.segments[1].end = p.segments[1].start; },
      [](TrackingPlan& p) { p.segments[1].start += 0.01; },
      [](TrackingPlan& p) { p.segments[2].samples = 1; },
      [](TrackingPlan& p) { p.segments.pop_back(); },
      [](TrackingPlan& p) { p.segments[0].in_contact.pop_back(); },
      [](TrackingPlan& p) { p.torque_limit(1) = -1.0; },
      [](TrackingPlan& p) { p.torque_curves[0].joint = 12; },
      [](TrackingPlan& p) { p.torque_curves[0].values.resize(1); },
      [](TrackingPlan& p) { p.torque_curves[1].upper = p.torque_curves[1].lower; },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    TrackingPlan plan = good;
    faults[i](plan);
    EXPECT_THROW(Tracker{plan}, TrackerError) << "fault " << i;
  }
}

// A robot with the joints of a humanoid; the budget of the control loop is 20 us.
TEST(Tracker, NeitherAllocatesNorTakesLong) {
  const Tracker tracker(test::random_tracking_plan(32, 500));
  const TrackingPlan& plan = tracker.plan();
  std::mt19937 rng(6);
  const VectorXd q = random_configuration(rng, plan.nu()), v = test::random_vector(rng, plan.nv(), 1.0);
  VectorXd tau(plan.nu());
#ifdef PROWL_COUNTS_ALLOCATIONS
  const long before_one = test::allocations;
  const VectorXd copy = q;
  EXPECT_GT(test::allocations, before_one) << "allocations go unseen";
#endif
  constexpr int kCalls = 20000;
  std::vector<double> batches;
  batches.reserve(100);
#ifdef PROWL_COUNTS_ALLOCATIONS
  const long start = test::allocations;
#endif
  double sum = 0.0;
  for (int batch = 0; batch < 100; ++batch) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kCalls / 100; ++i) {
      tracker.torque(1.7 * (batch * 200 + i) / kCalls, q, v, tau);
      sum += tau(0);
    }
    batches.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / (kCalls / 100));
  }
#ifdef PROWL_COUNTS_ALLOCATIONS
  EXPECT_EQ(test::allocations - start, 0);
#endif
  EXPECT_TRUE(std::isfinite(sum));
  std::nth_element(batches.begin(), batches.begin() + 50, batches.end());
  fmt::print("32 joints: {:.2f} us a call\n", batches[50] * 1e6);
  EXPECT_LT(batches[50], 20e-6);
}

}  // namespace
}  // namespace prowl
