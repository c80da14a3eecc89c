#include "prowl/tracking/rollout.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/tracking/displaced_start.hpp"
#include "prowl/tracking/linearised_dynamics.hpp"
#include "prowl/tracking/make_tracking_plan.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

struct Tracked {
  test::SolvedTask solved;
  FeedbackDesign design;
  Tracker tracker;
  const RobotModel& robot() const { return solved.task.problem.robot; }
};

Tracked track(const std::string& name) {
  test::SolvedTask solved = test::solve_task(name);
  FeedbackDesign design = design_feedback(solved.task.problem, solved.trajectory, solved.task.tracking);
  TrackingPlan plan = make_tracking_plan(solved.task.problem, design);
  return {std::move(solved), std::move(design), Tracker(std::move(plan))};
}

/// The start with its base moved, the feet where they are.
VectorXd moved_start(const Tracked& tracked, const VectorXd& base_move) {
  return displaced_start(tracked.robot(), tracked.tracker, base_move).q;
}

/// Base position [m] and orientation [rad] off the reference, and the velocity.
struct Error {
  double position, angle, speed;
};

Error error_of(const Tracker& tracker, const RolloutSample& at) {
  VectorXd q(at.q.size()), v(at.v.size());
  tracker.reference(at.time, q, v);
  const VectorXd d = difference(q, at.q);
  return {d.head<3>().norm(), d.segment<3>(3).norm(), (at.v - v).norm()};
}

class FourFootTask : public testing::TestWithParam<std::string> {};

// 2 cm and 2 degrees, in several directions at once, feet where they were: gone at the end of the motion. Open loop
// falls.
TEST_P(FourFootTask, ReturnsFromADisplacedBase) {
  const Tracked tracked = track(GetParam());
  const VectorXd rest = VectorXd::Zero(tracked.robot().nv());
  constexpr double kAngle = 2.0 * std::numbers::pi / 180.0;
  std::mt19937 rng(1);
  Error worst{};
  for (int i = 0; i < 3; ++i) {
    VectorXd move(6);
    move << 0.02 * test::random_vector(rng, 3, 1.0).normalized(),
        kAngle * test::random_vector(rng, 3, 1.0).normalized();
    const VectorXd q = moved_start(tracked, move);
    const Rollout closed = rollout(tracked.robot(), tracked.tracker, q, rest, {.control_step = 1e-3});
    ASSERT_FALSE(closed.fell);
    const Error start = error_of(tracked.tracker, closed.samples.front());
    EXPECT_NEAR(start.position, 0.02, 1e-9);
    EXPECT_NEAR(start.angle, kAngle, 1e-9);
    const Error end = error_of(tracked.tracker, closed.samples.back());
    worst = {std::max(worst.position, end.position), std::max(worst.angle, end.angle),
             std::max(worst.speed, end.speed)};
    EXPECT_LT(end.position, 2e-4);
    EXPECT_LT(end.angle, 2e-4);
    const Rollout open = rollout(tracked.robot(), tracked.tracker, q, rest, {.closed_loop = false});
    EXPECT_TRUE(open.fell) << "then the gains are for nothing";
  }
  fmt::print("{}: at the end {:.1e} m, {:.1e} rad, {:.1e}\n", GetParam(), worst.position, worst.angle, worst.speed);
}

INSTANTIATE_TEST_SUITE_P(All, FourFootTask,
                         testing::Values("hyq/stand", "hyq/crouch", "hyq/hold", "anymal_c/stand", "anymal_c/crouch",
                                         "go2/stand", "go2/crouch", "solo12/stand", "solo12/crouch"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

// Through contacts that open and land, and on standing for a second.
TEST(Rollout, FollowsMotionsThatChangeTheirContacts) {
  for (const char* name : {"hyq/balance", "hyq/step"}) {
    const Tracked tracked = track(name);
    const VectorXd rest = VectorXd::Zero(tracked.robot().nv());
    VectorXd move(6);
    move << 0.01, 0.01, -0.01, 0.02, -0.02, 0.02;
    const Rollout closed =
        rollout(tracked.robot(), tracked.tracker, moved_start(tracked, move), rest, {.stand_on = 1.0});
    ASSERT_FALSE(closed.fell) << name;
    EXPECT_NEAR(closed.samples.back().time, tracked.tracker.end() + 1.0, 1e-9);
    const Error end = error_of(tracked.tracker, closed.samples.back());
    EXPECT_LT(end.position, 1e-3) << name;
    EXPECT_LT(end.angle, 2e-3) << name;
    EXPECT_LT(end.speed, 1e-2) << name;
  }
}

// The report of the design: no small deviation is left larger at the end of the first phase than `worst` of it, and
// over many directions it is `mean`.
TEST(Rollout, DecaysAsTheDesignSays) {
  const Tracked tracked = track("hyq/step");
  const RobotModel& robot = tracked.robot();
  const TrajectoryPoint& start = tracked.solved.trajectory.nodes.front();
  const PhaseDecay& shift = tracked.design.decay.front();
  const VectorXd weight = tracked.solved.task.tracking.state_weight().cwiseSqrt();
  TrackingPlan first = tracked.tracker.plan();  // of the first phase alone
  first.segments.resize(1);
  const int samples = first.segments.front().samples;
  for (Eigen::MatrixXd* matrix : {&first.q, &first.v, &first.tau, &first.gains})
    *matrix = matrix->leftCols(samples).eval();
  const Tracker tracker(first);
  const RolloutOptions options{.tolerance = 1e-11};
  const Rollout nominal = rollout(robot, tracker, start.q, start.v, options);

  LinearisedDynamics linear(robot, tracked.design.phases.front().contacts);
  linear.evaluate(start.q, start.v, start.tau);
  const Eigen::MatrixXd Z = linear.consistent_directions(tracked.solved.task.tracking.state_weight());
  double squares = 0.0, worst = 0.0;
  for (Eigen::Index i = 0; i < Z.cols(); ++i) {
    constexpr double kSmall = 1e-4;  // of the deviations that cost 1
    const VectorXd q = integrate(start.q, kSmall * Z.col(i).head(robot.nv()));
    const Rollout off = rollout(robot, tracker, q, start.v + kSmall * Z.col(i).tail(robot.nv()), options);
    ASSERT_EQ(off.samples.size(), nominal.samples.size());
    VectorXd dx(2 * robot.nv());
    dx << difference(nominal.samples.back().q, off.samples.back().q), off.samples.back().v - nominal.samples.back().v;
    const double left = weight.cwiseProduct(dx).norm() / kSmall;
    worst = std::max(worst, left);
    squares += left * left;
  }
  const double mean = std::sqrt(squares / static_cast<double>(Z.cols()));
  EXPECT_LT(worst, 1.02 * shift.worst);
  EXPECT_NEAR(mean, shift.mean, 0.02 * shift.mean);
  EXPECT_GT(mean, 1e-3) << "nothing is left to compare";
}

// Feet stay where they were at the start, not where the plan has them, and carry the weight.
TEST(Rollout, KeepsTheContactsOfItsSchedule) {
  const Tracked tracked = track("hyq/crouch");
  const RobotModel& robot = tracked.robot();
  VectorXd move(6);
  move << 0.02, 0.0, 0.0, 0.0, 0.03, 0.0;
  const VectorXd q = moved_start(tracked, move);
  const Rollout closed = rollout(robot, tracked.tracker, q, VectorXd::Zero(robot.nv()), {});
  RigidBodyTerms terms(robot);
  terms.update_kinematics(q);
  std::vector<Eigen::Vector3d> positions;
  for (int c = 0; c < 4; ++c) positions.push_back(terms.contact_position(c));
  for (const RolloutSample& at : closed.samples) {
    terms.update_kinematics(at.q);
    for (int c = 0; c < 4; ++c) EXPECT_LT((terms.contact_position(c) - positions[c]).norm(), 1e-6);
  }
  // Standing on the last posture the forces carry the weight.
  double carried = 0.0;
  const Rollout standing = rollout(robot, tracked.tracker, tracked.solved.trajectory.nodes.front().q,
                                   VectorXd::Zero(robot.nv()), {.stand_on = 2.0});
  for (int c = 0; c < 4; ++c) carried += standing.samples.back().force(3 * c + 2);
  EXPECT_NEAR(carried, robot.weight(), 1e-3 * robot.weight());
}

/// No contact, no torque, no gains.
Tracker flight(const RobotModel& robot, const VectorXd& q, double duration) {
  TrackingPlan plan;
  plan.joint_names = robot.joint_names();
  for (const ContactPoint& contact : robot.contacts()) plan.contact_names.push_back(contact.name);
  plan.torque_limit = robot.torque_limit();
  plan.segments = {{"flight", 0.0, duration, 0, 2, std::vector<bool>(robot.contacts().size(), false)}};
  plan.q = q.replicate(1, 2);
  plan.v.setZero(robot.nv(), 2);
  plan.tau.setZero(robot.nu(), 2);
  plan.gains.setZero(2L * robot.nu() * robot.nv(), 2);
  return Tracker(plan);
}

// Tumbling in the air: the same however wide the chart gets between two samples, and its momentum changes by the
// weight.
TEST(Rollout, Tumbles) {
  const Task task = read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/stand.toml", test::test_search());
  const RobotModel& robot = task.problem.robot;
  constexpr double kDuration = 0.12;
  const VectorXd& q = task.problem.start_configuration();
  const Tracker tracker = flight(robot, q, kDuration);
  std::mt19937 rng(5);
  VectorXd v(robot.nv());
  v << 0.5, 0.0, 1.0, 2.0, -1.5, 1.0, test::random_vector(rng, robot.nu(), 3.0);
  const Rollout wide = rollout(robot, tracker, q, v, {.sample_step = kDuration, .tolerance = 1e-11}),
                narrow = rollout(robot, tracker, q, v, {.sample_step = 1e-3, .tolerance = 1e-11});
  ASSERT_FALSE(wide.fell || narrow.fell);
  const RolloutSample &one = wide.samples.back(), &other = narrow.samples.back();
  EXPECT_GT(difference(q, one.q).segment<3>(3).norm(), 0.2) << "too little of a turn to tell";
  EXPECT_LT(difference(one.q, other.q).norm(), 1e-8);
  EXPECT_LT((one.v - other.v).norm(), 1e-7);

  RigidBodyTerms terms(robot);
  const auto momentum = [&](const VectorXd& at_q, const VectorXd& at_v) {
    terms.update_with_derivatives(at_q, at_v, VectorXd::Zero(robot.nv()));
    return Eigen::Vector3d(base_rotation(at_q) * (terms.mass_matrix() * at_v).head<3>());
  };
  const Eigen::Vector3d change = momentum(one.q, one.v) - momentum(q, v);
  EXPECT_LT((change + robot.weight() * kDuration * Eigen::Vector3d::UnitZ()).norm(), 1e-6 * robot.weight());
}

TEST(Rollout, IsTheSameEveryTime) {
  const Tracked tracked = track("hyq/stand");
  VectorXd move = VectorXd::Constant(6, 0.01);
  const VectorXd q = moved_start(tracked, move), rest = VectorXd::Zero(tracked.robot().nv());
  const Rollout one = rollout(tracked.robot(), tracked.tracker, q, rest, {}),
                two = rollout(tracked.robot(), tracked.tracker, q, rest, {});
  ASSERT_EQ(one.samples.size(), two.samples.size());
  for (std::size_t i = 0; i < one.samples.size(); ++i) {
    EXPECT_EQ(one.samples[i].q, two.samples[i].q);
    EXPECT_EQ(one.samples[i].tau, two.samples[i].tau);
  }
}

}  // namespace
}  // namespace prowl
