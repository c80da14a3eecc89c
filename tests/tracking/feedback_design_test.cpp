#include "prowl/tracking/feedback_design.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/tracker/tracker.hpp"
#include "prowl/tracking/linearised_dynamics.hpp"
#include "prowl/tracking/make_tracking_plan.hpp"
#include "prowl/tracking/reference_grid.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Plans are made once.
const test::SolvedTask& solved(const std::string& name) {
  static std::map<std::string, test::SolvedTask> tasks;
  const auto found = tasks.find(name);
  return found != tasks.end() ? found->second : tasks.emplace(name, test::solve_task(name)).first->second;
}

FeedbackDesign design(const test::SolvedTask& solved, const TrackingOptions& options) {
  return design_feedback(solved.task.problem, solved.trajectory, options);
}

FeedbackDesign design(const std::string& name) { return design(solved(name), solved(name).task.tracking); }

class FeedbackOfTask : public testing::TestWithParam<std::string> {};

// Independent and redundant contacts, contacts that change: deviations that the contacts do not allow get no torque but
// from the impedance F of feet that landed, in the metric of the weights with less on the legs in stance:
// (K - F) W⁻¹ C' = 0.
TEST_P(FeedbackOfTask, HasNoGainOnWhatTheContactsForbid) {
  const test::SolvedTask& task = solved(GetParam());
  const FeedbackDesign found = design(GetParam());
  const RobotModel& robot = task.task.problem.robot;
  const double fading = 1.2 * std::sqrt(robot.nominal_configuration().z() / RobotModel::kGravity);
  std::vector<double> landed(robot.contacts().size(), -1e3);  // of each contact [s]
  for (std::size_t p = 0; p < found.phases.size(); ++p) {
    const ReferencePhase& phase = found.phases[p];
    for (const int contact : phase.contacts) {
      const bool lands = p > 0 && std::ranges::count(found.phases[p - 1].contacts, contact) == 0;
      if (lands) landed[static_cast<std::size_t>(contact)] = phase.start();
    }
    LinearisedDynamics linear(task.task.problem.robot, phase.contacts);
    for (std::size_t k = 0; k < phase.samples.size(); k += 37) {
      const TrajectoryPoint& point = phase.samples[k];
      linear.evaluate(point.q, point.v, point.tau);
      const VectorXd weight = linear.with_stance_legs(task.task.tracking.state_weight(), 0.1);
      const MatrixXd forbidden = weight.cwiseInverse().asDiagonal() * linear.C().transpose();
      VectorXd rates(static_cast<Eigen::Index>(phase.contacts.size()));
      for (std::size_t i = 0; i < phase.contacts.size(); ++i) {
        const double since = point.time - landed[static_cast<std::size_t>(phase.contacts[i])];
        rates(static_cast<Eigen::Index>(i)) =
            task.task.tracking.largest_bandwidth * std::max(0.0, 1.0 - since / fading);
      }
      const MatrixXd K = found.gains[p][k] - linear.impedance(rates);
      EXPECT_GT(K.norm(), 1.0);
      EXPECT_LT((K * forbidden).norm(), 1e-9 * K.norm() * forbidden.norm()) << phase.name << ", sample " << k;
    }
  }
}

TEST_P(FeedbackOfTask, KeepsItsBandwidthAndStandsOn) {
  const test::SolvedTask& task = solved(GetParam());
  const FeedbackDesign found = design(GetParam());
  const double limit = task.task.tracking.largest_bandwidth;
  EXPECT_TRUE(found.stands_on);
  EXPECT_GT(found.slowest_rate, 0.5);
  EXPECT_LE(found.whole.bandwidth, limit);
  EXPECT_LT(found.whole.worst, 1e-3) << "a deviation at the start is gone at the end";
  ASSERT_EQ(found.decay.size() + 1, found.phases.size());
  for (const PhaseDecay& decay : found.decay) {
    EXPECT_GT(decay.mean, 0.0);
    EXPECT_LE(decay.mean, decay.worst);
    EXPECT_THAT(decay.worst_direction, testing::Not(testing::IsEmpty()));
  }
  // The crossing frequencies, here as eigenvalues of the loop itself: B' (C B = 0) and dtau have the same.
  for (std::size_t p = 0; p < found.phases.size(); ++p) {
    LinearisedDynamics linear(task.task.problem.robot, found.phases[p].contacts);
    for (std::size_t k = 0; k < found.phases[p].samples.size(); k += 37) {
      const TrajectoryPoint& point = found.phases[p].samples[k];
      linear.evaluate(point.q, point.v, point.tau);
      const Eigen::VectorXcd rates = (found.gains[p][k] * linear.B()).eigenvalues();
      EXPECT_LT(rates.cwiseAbs().maxCoeff(), limit * (1.0 + 1e-6));
      EXPECT_GT(rates.real().minCoeff(), -1e-6 * limit);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, FeedbackOfTask, testing::Values("hyq/stand", "hyq/balance", "hyq/kneel", "solo12/step"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

// The reference after the end is an equilibrium: without a deviation the robot does not move.
TEST(FeedbackDesign, StandsStillAfterTheEnd) {
  const test::SolvedTask& task = solved("hyq/crouch");
  const FeedbackDesign found = design("hyq/crouch");
  const ReferencePhase& after = found.phases.back();
  EXPECT_EQ(after.name, "stand on");
  ForwardDynamics dynamics(task.task.problem.robot, after.contacts);
  dynamics.evaluate(after.samples.back().q, after.samples.back().v, after.samples.back().tau);
  EXPECT_LT(dynamics.acceleration().norm(), 1e-6);
  EXPECT_EQ(after.samples.back().v.norm(), 0.0);
}

TEST(FeedbackDesign, HasNoGainsToStandOnWithInTheAir) {
  test::SolvedTask task = solved("hyq/jump");
  task.trajectory.nodes.erase(std::find_if(task.trajectory.nodes.begin(), task.trajectory.nodes.end(),
                                           [](const TrajectoryPoint& node) { return node.phase == 3; }),
                              task.trajectory.nodes.end());
  const FeedbackDesign found = design(task, task.task.tracking);
  EXPECT_FALSE(found.stands_on);
  EXPECT_EQ(found.phases.size(), 3u);
  EXPECT_TRUE(found.gains.front().front().allFinite());
}

TEST(FeedbackDesign, DoesNotStandOnWithGainsThatTheBandwidthCuts) {
  const test::SolvedTask& task = solved("hyq/stand");
  TrackingOptions options = task.task.tracking;
  options.largest_bandwidth = 2.0;
  const FeedbackDesign found = design(task, options);
  EXPECT_FALSE(found.stands_on);
  EXPECT_LT(found.slowest_rate, 0.0) << "a deviation grows";
}

// Halving the step of the grid brings the gains nearer to their limit by the square of it.
TEST(FeedbackDesign, ConvergesWithTheGrid) {
  const test::SolvedTask& task = solved("hyq/crouch");
  std::vector<MatrixXd> first_gain;
  for (const double step : {0.04, 0.02, 0.01}) {
    TrackingOptions options = task.task.tracking;
    options.step = step;
    first_gain.push_back(design(task, options).gains.front().front());
  }
  const double coarse = (first_gain[0] - first_gain[1]).norm(), fine = (first_gain[1] - first_gain[2]).norm();
  EXPECT_GT(coarse, 0.0);
  EXPECT_LT(fine, coarse / 3.0);
  EXPECT_LT(fine, 1e-2 * first_gain[2].norm());
}

/// What a landing cuts off costs in proportion to TrackingOptions::landing_time, in the swing that ends with it.
TEST(FeedbackDesign, CountsWhatALandingCutsOff) {
  const test::SolvedTask& task = solved("solo12/step");
  constexpr int kSwing = 1;
  std::vector<MatrixXd> at_landing;
  for (const double time : {1.0, 2.0, 4.0}) {
    TrackingOptions options = task.task.tracking;
    options.landing_time = time;
    MatrixXd cost;
    design_feedback(task.task.problem, task.trajectory, options, [&](const ReducedSample& at) {
      if (at.phase == kSwing && cost.size() == 0) cost = at.S;  // samples come last first
    });
    at_landing.push_back(cost);
  }
  const MatrixXd once = at_landing[1] - at_landing[0], twice = at_landing[2] - at_landing[1];
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(once).eigenvalues().maxCoeff(), 0.1) << "a foot beside its place";
  EXPECT_LT((twice - 2.0 * once).norm(), 1e-9 * at_landing[2].norm());
}

/// Where the motion ends at rest, its last torques go on: they are those that friction and limits hold for.
TEST(FeedbackDesign, StandsOnWithTheLastTorques) {
  for (const char* name : {"hyq/step", "hyq/wall", "solo12/trot"}) {
    const FeedbackDesign found = design(name);
    ASSERT_EQ(found.phases.back().name, "stand on") << name;
    const TrajectoryPoint& last = found.phases[found.phases.size() - 2].samples.back();
    const TrajectoryPoint& after = found.phases.back().samples.front();
    const VectorXd limit = solved(name).task.problem.robot.torque_limit();
    EXPECT_LT((after.tau - last.tau).cwiseQuotient(limit).lpNorm<Eigen::Infinity>(), 1e-4) << name;
  }
}

/// A deviation from a goal costs in proportion to TrackingOptions::goal_time, of the entries that the goal bounds only.
TEST(FeedbackDesign, CountsWhatMissesAGoal) {
  const test::SolvedTask& task = solved("hyq/rear");
  MotionProblem problem = task.task.problem;
  problem.boundary_constraints.resize(2, problem.start());  // the start and one goal, in the middle of the motion
  const BoundaryConstraint& goal = problem.boundary_constraints[1];
  std::vector<MatrixXd> at_goal;
  MatrixXd basis;
  for (const double time : {0.0, 1.0, 3.0}) {
    TrackingOptions options = task.task.tracking;
    options.goal_time = time;
    MatrixXd cost;
    const auto phase = reference_grid(problem, task.trajectory, options.step).at(goal.at.phase);
    const long sample = std::lround(goal.at.fraction * static_cast<double>(phase.samples.size() - 1));
    design_feedback(problem, task.trajectory, options, [&](const ReducedSample& at) {
      if (at.phase != goal.at.phase || at.sample != sample) return;
      cost = at.S;
      basis = at.Z;
    });
    at_goal.push_back(cost);
  }
  VectorXd weight = task.task.tracking.state_weight();
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    const bool is_turn = i >= 3 && i < 6;
    if (!is_turn) weight(i) = 0.0;
  }
  EXPECT_TRUE(goal.configuration_upper.segment<3>(3).allFinite());
  EXPECT_FALSE(goal.configuration_upper.head<3>().array().isFinite().any());
  const MatrixXd expected = basis.transpose() * weight.asDiagonal() * basis;
  // What follows the goal costs the same in all three, in the same basis: Z comes from what follows, too.
  const double accuracy = 1e-9 * at_goal[2].norm();
  EXPECT_LT((at_goal[1] - at_goal[0] - expected).norm(), accuracy);
  EXPECT_LT((at_goal[2] - at_goal[0] - 3.0 * expected).norm(), accuracy);
}

/// A leg whose foot is not at its foothold: pulled back when it should have landed, let be once it stands.
TEST(FeedbackDesign, StiffensALegThatLands) {
  constexpr std::size_t kLanded = 2;
  const FeedbackDesign found = design("hyq/step");
  const std::vector<int>& before = found.phases[kLanded - 1].contacts;
  const std::vector<int>& after = found.phases[kLanded].contacts;
  const auto landed = std::ranges::find_if(after, [&](int c) { return std::ranges::count(before, c) == 0; });
  ASSERT_NE(landed, after.end());
  const Eigen::Index knee = 6 + 3 * *landed + 2;  // HyQ's contacts are in the order of its legs
  const auto pull = [&](std::size_t sample) { return found.gains[kLanded][sample].col(knee)(knee - 6); };
  EXPECT_GT(pull(0), 10.0);
  EXPECT_LT(std::abs(pull(found.gains[kLanded].size() - 1)), 0.3 * pull(0));
}

/// Feet in the air cost besides their joints: more, the smaller the deviation that costs 1.
TEST(FeedbackDesign, CountsFeetInTheAir) {
  const test::SolvedTask& task = solved("solo12/step");
  std::vector<MatrixXd> in_swing;
  for (const double deviation : {0.1, 0.01}) {
    TrackingOptions options = task.task.tracking;
    options.swing_foot_deviation = deviation;
    MatrixXd cost;
    design_feedback(task.task.problem, task.trajectory, options, [&](const ReducedSample& at) {
      if (at.phase == 1) cost = at.Z * at.S * at.Z.transpose();  // of the first sample in the end; Z turns
    });
    in_swing.push_back(cost);
  }
  const VectorXd more = Eigen::SelfAdjointEigenSolver<MatrixXd>(in_swing[1] - in_swing[0]).eigenvalues();
  EXPECT_GT(more.maxCoeff(), 0.0);
  EXPECT_GT(more.minCoeff(), -1e-6 * more.maxCoeff());
}

TEST(FeedbackDesign, WeighsAsItIsTold) {
  const test::SolvedTask& task = solved("hyq/stand");
  TrackingOptions options = task.task.tracking;
  const MatrixXd before = design(task, options).gains.front().front();
  options.state_deviation.head<3>() *= 0.5;
  options.torque_deviation *= 2.0;
  const MatrixXd stiffer = design(task, options).gains.front().front();
  EXPECT_GT(stiffer.leftCols<3>().norm(), 1.5 * before.leftCols<3>().norm());
}

// What goes to the robot is what was designed.
TEST(MakeTrackingPlan, HasTheReferenceTheGainsAndTheSchedule) {
  const test::SolvedTask& task = solved("hyq/balance");
  const MotionProblem& problem = task.task.problem;
  const FeedbackDesign found = design("hyq/balance");
  const Tracker tracker(make_tracking_plan(problem, found));
  MatrixXd K(problem.robot.nu(), 2 * problem.robot.nv());
  VectorXd q(problem.robot.nq()), v(problem.robot.nv()), tau(problem.robot.nu());
  for (std::size_t p = 0; p < found.phases.size(); ++p) {
    const ReferencePhase& phase = found.phases[p];
    const TrackingPlan::Segment& segment = tracker.segment(0.5 * (phase.start() + phase.end()));
    EXPECT_EQ(segment.name, phase.name);
    for (int c = 0; c < static_cast<int>(problem.robot.contacts().size()); ++c) {
      const bool held = std::find(phase.contacts.begin(), phase.contacts.end(), c) != phase.contacts.end();
      EXPECT_EQ(segment.in_contact[c], held);
    }
    for (std::size_t k = 0; k + 1 < phase.samples.size(); ++k) {
      const TrajectoryPoint& point = phase.samples[k];
      tracker.gains(point.time, K);
      EXPECT_LT((K - found.gains[p][k]).norm(), 1e-9 * K.norm());
      tracker.torque(point.time, point.q, point.v, tau);
      const Eigen::VectorXd motor = point.tau + problem.robot.losses().torques(point.v.tail(problem.robot.nu()));
      EXPECT_LT((tau - motor).norm(), 1e-6 * (1.0 + motor.norm())) << "on the reference, its torque";
    }
  }
  EXPECT_EQ(tracker.plan().joint_names, problem.robot.joint_names());
  // Between samples too: as far off the motion as a parabola is off its chords.
  for (double t = 0.0; t < task.trajectory.duration(); t += 0.0137) {
    const TrajectoryPoint point = sample(task.trajectory, t);
    tracker.reference(t, q, v);
    EXPECT_LT((q.tail(12) - point.q.tail(12)).cwiseAbs().maxCoeff(), 1e-4);
    EXPECT_LT((v - point.v).cwiseAbs().maxCoeff(), 2e-2);
  }
}

}  // namespace
}  // namespace prowl
