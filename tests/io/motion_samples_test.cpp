// Samples of a motion with a switch of contacts: nodes or a rate, gains on both sides of the switch, simulations.
#include "prowl/io/motion_samples.hpp"

#include <gmock/gmock.h>

#include "prowl/error.hpp"
#include "prowl/io/trajectory_csv.hpp"
#include "prowl/tracking/feedback_design.hpp"
#include "prowl/tracking/make_tracking_plan.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

class Samples : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    solved_ = std::make_unique<test::SolvedTask>(test::solve_task("hyq/step"));
    const FeedbackDesign design = design_feedback(solved_->task.problem, solved_->trajectory, solved_->task.tracking);
    tracker_ = std::make_unique<Tracker>(make_tracking_plan(solved_->task.problem, design));
  }
  static void TearDownTestSuite() {
    tracker_.reset();
    solved_.reset();
  }
  static const MotionProblem& problem() { return solved_->task.problem; }
  static const Trajectory& plan() { return solved_->trajectory; }
  static std::unique_ptr<test::SolvedTask> solved_;
  static std::unique_ptr<Tracker> tracker_;
};
std::unique_ptr<test::SolvedTask> Samples::solved_;
std::unique_ptr<Tracker> Samples::tracker_;

TEST_F(Samples, AtTheNodesHaveTheGainsOfTheirOwnPhase) {
  const MotionSamples samples = sample_plan(problem(), plan(), tracker_.get(), {});
  ASSERT_EQ(samples.points.size(), plan().nodes.size());
  ASSERT_EQ(samples.gains.size(), samples.points.size());
  EXPECT_FALSE(samples.simulated);
  Eigen::MatrixXd K(problem().robot.nu(), 2 * problem().robot.nv());
  int switches = 0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const TrajectoryPoint& point = samples.points[i];
    EXPECT_EQ(point.q, plan().nodes[i].q);
    const bool ends_phase = i + 1 < samples.points.size() && samples.points[i + 1].phase != point.phase;
    const double t = ends_phase ? std::nextafter(point.time, 0.0) : point.time;
    if (i + 1 == samples.points.size()) continue;  // there the tracker goes on standing
    tracker_->gains(t, K);
    EXPECT_LT((samples.gains[i] - K).norm(), 1e-9 * K.norm()) << i;
    if (!ends_phase) continue;
    ++switches;
    EXPECT_GT((samples.gains[i + 1] - samples.gains[i]).norm(), 1e-3 * K.norm()) << "other contacts, other gains";
    EXPECT_NE(samples.in_contact[i + 1], samples.in_contact[i]);
  }
  EXPECT_GE(switches, 2);
  const std::vector<std::size_t> once = samples.one_a_time();
  EXPECT_EQ(once.size() + static_cast<std::size_t>(switches), samples.points.size());
  for (std::size_t k = 1; k < once.size(); ++k)
    EXPECT_LT(samples.points[once[k - 1]].time, samples.points[once[k]].time);
}

TEST_F(Samples, AtARateAreTheTrajectory) {
  const MotionSamples samples = sample_plan(problem(), plan(), tracker_.get(), 90.0);
  const double end = plan().duration();
  EXPECT_EQ(samples.points.size(), static_cast<std::size_t>(std::ceil(end * 90.0 - 1e-9)) + 1);
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const double t = std::min(static_cast<double>(i) / 90.0, end);
    EXPECT_NEAR(samples.points[i].time, t, 1e-12);
    EXPECT_EQ(samples.points[i].tau, sample(plan(), samples.points[i].time).tau);
  }
  EXPECT_EQ(samples.one_a_time().size(), samples.points.size());
  EXPECT_TRUE(sample_plan(problem(), plan(), nullptr, 90.0).gains.empty());
}

TEST_F(Samples, RefuseARateThatMakesNoSense) {
  for (const double rate : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e9}) {
    EXPECT_THROW(sample_plan(problem(), plan(), nullptr, rate), InputError) << rate;
  }
}

}  // namespace
}  // namespace prowl
