#include "prowl/trajectory/trajectory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "prowl/model/configuration.hpp"
#include "prowl/trajectory/hermite_interval.hpp"

namespace prowl {
namespace {

constexpr int kJoints = 4;
constexpr int kContacts = 2;

Eigen::VectorXd random_vector(std::mt19937& rng, int size, double scale = 1.0) {
  std::uniform_real_distribution<double> uniform(-scale, scale);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(rng); });
}

TrajectoryPoint random_node(std::mt19937& rng, double time) {
  TrajectoryPoint node;
  node.time = time;
  Eigen::VectorXd origin = Eigen::VectorXd::Zero(7 + kJoints);
  origin(6) = 1.0;
  node.q = integrate(origin, random_vector(rng, 6 + kJoints, 1.5));
  node.v = random_vector(rng, 6 + kJoints, 2.0);
  node.a = random_vector(rng, 6 + kJoints, 5.0);
  node.tau = random_vector(rng, kJoints, 10.0);
  node.force = random_vector(rng, 3 * kContacts, 100.0);
  return node;
}

/// A node that follows `left` by the trapezoid without a defect; a, tau and force are free.
TrajectoryPoint stepped(std::mt19937& rng, const TrajectoryPoint& left, double h) {
  TrajectoryPoint right = random_node(rng, left.time + h);
  right.v = left.v + 0.5 * h * (left.a + right.a);
  // The rotation first: the position needs the new velocity in the world.
  Eigen::VectorXd half = 0.5 * h * right.v;
  right.q = integrate(integrate(left.q, 0.5 * h * tangent_rate(left)), half);
  half.head<3>() = base_rotation(right.q) * half.head<3>();
  right.q = integrate(integrate(left.q, 0.5 * h * tangent_rate(left)), half);
  return right;
}

void expect_same(const TrajectoryPoint& a, const TrajectoryPoint& b, double tolerance) {
  EXPECT_NEAR(a.time, b.time, tolerance);
  EXPECT_EQ(a.phase, b.phase);
  EXPECT_LT(difference(a.q, b.q).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((a.v - b.v).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((a.a - b.a).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((a.tau - b.tau).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((a.force - b.force).cwiseAbs().maxCoeff(), tolerance);
}

TEST(Interpolate, MeetsBothNodesOfAnExactStep) {
  std::mt19937 rng(1);
  for (int i = 0; i < 100; ++i) {
    const double h = 0.01 + 0.003 * i;
    const TrajectoryPoint left = random_node(rng, 0.3);
    const TrajectoryPoint right = stepped(rng, left, h);
    expect_same(interpolate(left, right, 0.0), left, 1e-12);
    expect_same(interpolate(left, right, h), right, 1e-12);
  }
}

TEST(Interpolate, DoesNotMeetANodeThatHasADefect) {
  std::mt19937 rng(2);
  const TrajectoryPoint left = random_node(rng, 0.0);
  TrajectoryPoint right = stepped(rng, left, 0.1);
  right.v(3) += 1e-3;
  EXPECT_GT((interpolate(left, right, 0.1).v - right.v).norm(), 0.9e-3);
}

TEST(Interpolate, VelocityIsTheIntegralOfAcceleration) {
  std::mt19937 rng(3);
  constexpr double h = 0.2, dt = 1e-4;
  const TrajectoryPoint left = random_node(rng, 0.0);
  const TrajectoryPoint right = stepped(rng, left, h);
  for (double s : {0.01, 0.07, 0.1, 0.19}) {
    const Eigen::VectorXd rate = (interpolate(left, right, s + dt).v - interpolate(left, right, s - dt).v) / (2 * dt);
    EXPECT_LT((rate - interpolate(left, right, s).a).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Interpolate, RateIsTheDerivativeOfTheConfiguration) {
  std::mt19937 rng(7);
  constexpr double h = 0.2, dt = 1e-5;
  const TrajectoryPoint left = random_node(rng, 0.0), right = stepped(rng, left, h);
  for (double s : {0.01, 0.07, 0.1, 0.19}) {
    const Eigen::VectorXd step = difference(interpolate(left, right, s - dt).q, interpolate(left, right, s + dt).q);
    EXPECT_LT((step / (2 * dt) - interpolated_rate(left, right, s)).cwiseAbs().maxCoeff(), 1e-8);
  }
  EXPECT_LT((interpolated_rate(left, right, 0.0) - tangent_rate(left)).norm(), 1e-12);
  EXPECT_LT((interpolated_rate(left, right, h) - tangent_rate(right)).norm(), 1e-12);
}

/// Largest |dq/dt - v| inside an interval of step h of one smooth motion, in the tangent.
double velocity_mismatch(double h) {
  std::mt19937 rng(4);
  const TrajectoryPoint left = random_node(rng, 0.0);
  TrajectoryPoint right = stepped(rng, left, h);
  right.a = left.a;  // a motion that depends on h smoothly: only then does its error have an order
  right.v = left.v + h * left.a;
  double largest = 0.0;
  for (double part : {0.25, 0.5, 0.75}) {
    const Eigen::VectorXd mismatch =
        interpolated_rate(left, right, part * h) - tangent_rate(interpolate(left, right, part * h));
    largest = std::max(largest, mismatch.cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(Interpolate, RateOfConfigurationIsTheVelocityUpToSecondOrder) {
  const double coarse = velocity_mismatch(0.04), fine = velocity_mismatch(0.02);
  EXPECT_GT(coarse, 1e-6) << "nothing to compare";
  EXPECT_GT(coarse / fine, 3.5);
  EXPECT_LT(coarse / fine, 4.5);
}

Trajectory two_phases(std::mt19937& rng) {
  Trajectory trajectory;
  trajectory.nodes.push_back(random_node(rng, 0.0));
  trajectory.nodes.push_back(stepped(rng, trajectory.nodes.back(), 0.25));
  TrajectoryPoint next_phase = trajectory.nodes.back();
  next_phase.phase = 1;
  next_phase.tau *= -1.0;
  trajectory.nodes.push_back(next_phase);
  trajectory.nodes.push_back(stepped(rng, next_phase, 0.5));
  trajectory.nodes.back().phase = 1;
  return trajectory;
}

TEST(Sample, FollowsTheCubicsAndTheTorqueInTheMiddle) {
  std::mt19937 rng(8);
  Trajectory trajectory = two_phases(rng);
  trajectory.interpolation = Interpolation::hermite;
  const std::vector<TrajectoryPoint>& nodes = trajectory.nodes;
  expect_same(sample(trajectory, 0.35), hermite_point(nodes[2], nodes[3], nullptr, 0.1), 1e-12);
  trajectory.middle_torques = {random_vector(rng, kJoints, 10.0), random_vector(rng, kJoints, 10.0)};
  for (const std::size_t interval : {0u, 1u}) {
    const TrajectoryPoint &left = nodes[2 * interval], &right = nodes[2 * interval + 1];
    const double middle = 0.5 * (left.time + right.time);
    EXPECT_LT((sample(trajectory, middle).tau - trajectory.middle_torques[interval]).norm(), 1e-12);
    EXPECT_GT((sample(trajectory, middle).q - interpolate(left, right, middle - left.time).q).norm(), 1e-4);
  }
}

TEST(Sample, TakesTheLaterPhaseAtATransition) {
  std::mt19937 rng(5);
  const Trajectory trajectory = two_phases(rng);
  expect_same(sample(trajectory, 0.25), trajectory.nodes[2], 1e-12);
  EXPECT_EQ(sample(trajectory, 0.25 - 1e-9).phase, 0);
}

TEST(Sample, InterpolatesBetweenNodesAndKeepsToTheEnds) {
  std::mt19937 rng(6);
  const Trajectory trajectory = two_phases(rng);
  const auto& nodes = trajectory.nodes;
  expect_same(sample(trajectory, 0.1), interpolate(nodes[0], nodes[1], 0.1), 1e-12);
  expect_same(sample(trajectory, 0.6), interpolate(nodes[2], nodes[3], 0.35), 1e-12);
  expect_same(sample(trajectory, 0.0), nodes.front(), 1e-12);
  expect_same(sample(trajectory, trajectory.duration()), nodes.back(), 1e-12);
  expect_same(sample(trajectory, 9.0), nodes.back(), 1e-12);
  expect_same(sample(trajectory, -1.0), nodes.front(), 1e-12);
}

}  // namespace
}  // namespace prowl
