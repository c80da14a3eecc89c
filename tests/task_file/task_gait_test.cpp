// [gait] of a task file.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "prowl/model/configuration.hpp"
#include "prowl/motion/gait.hpp"
#include "tests/support/task_test.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string kGaitFile = R"(robot = "hyq.toml"
[gait]
kind = "trot"
strides = 3
stride_s = 0.8
stride_length_m = 0.2
[cost]
torque = 1e-3
)";

class TaskGait : public test::TaskTest {
 protected:
  /// What the user sees if `from` in the right task is replaced by `to`.
  std::string message(const std::string& from, const std::string& to) {
    return message_of(test::replaced(kGaitFile, from, to));
  }
};

TEST_F(TaskGait, StandsForPhasesAndAGoal) {
  const Task task = read(kGaitFile);
  const MotionProblem& problem = task.problem;
  ASSERT_EQ(problem.phases.size(), 1u + 3 * 4 - 1 + 1);
  EXPECT_EQ(problem.phases[1].name, "stride 1: lf_foot and rh_foot swing");
  EXPECT_NEAR(problem.phases[1].duration.min, 0.4 * 0.8, 1e-12);
  EXPECT_FALSE(task.has_intervals);
  EXPECT_EQ(task.mesh.phases[1].intervals(), 4);

  ASSERT_EQ(problem.boundary_constraints.size(), 2u);
  const BoundaryConstraint& goal = problem.boundary_constraints[1];
  EXPECT_EQ(goal.name, "goal 1");
  EXPECT_EQ(goal.at, PhaseFraction::end_of(12));
  EXPECT_EQ(task.mesh.phases[12].intervals(), 5);
  const Eigen::VectorXd moved = difference(problem.start_configuration(), goal.q_ref);
  EXPECT_NEAR((moved.head<3>() - Eigen::Vector3d(0.6, 0.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(moved.tail(15).norm(), 0.0, 1e-12);
}

/// The same condition as written out in full, but for what [[goal]] calls the motion.
TEST_F(TaskGait, GoalIsThatOfAGoalInTheFile) {
  const BoundaryConstraint implied = read(kGaitFile).problem.boundary_constraints[1];
  const std::string goal = R"([[goal]]
phase = "settle"
base_displacement_m = [0.6, 0, 0]
base_rpy_rad = [0, 0, 0]
base_linear_velocity_mps = [0, 0, 0]
base_angular_velocity_radps = [0, 0, 0]
[cost])";
  const std::string written = test::replaced(test::replaced(kGaitFile, "stride_length_m = 0.2\n", ""), "[cost]", goal);
  const BoundaryConstraint wanted = read(written).problem.boundary_constraints.at(1);
  EXPECT_EQ(implied.at, wanted.at);
  EXPECT_TRUE(implied.q_ref.isApprox(wanted.q_ref, 1e-14));
  EXPECT_EQ(implied.configuration_lower, wanted.configuration_lower);
  EXPECT_EQ(implied.configuration_upper, wanted.configuration_upper);
  EXPECT_EQ(implied.velocity_lower, wanted.velocity_lower);
  EXPECT_EQ(implied.velocity_upper, wanted.velocity_upper);
  EXPECT_EQ(implied.torque_upper, wanted.torque_upper);
}

TEST_F(TaskGait, GoesWhereTheBaseFacesUnlessSaid) {
  const auto goal = [&](const std::string& to) {
    const MotionProblem problem = read(test::replaced(kGaitFile, "[cost]", to + "\n[cost]")).problem;
    return Eigen::Vector3d(base_position(problem.boundary_constraints.at(1).q_ref) -
                           base_position(problem.start_configuration()));
  };
  EXPECT_NEAR(
      (goal("[start]\nbase_rpy_rad = [0, 0, 1.0]") - 0.6 * Eigen::Vector3d(std::cos(1.0), std::sin(1.0), 0)).norm(),
      0.0, 1e-12);
  EXPECT_NEAR((goal("heading_rad = 3.0") - 0.6 * Eigen::Vector3d(std::cos(3.0), std::sin(3.0), 0)).norm(), 0.0, 1e-12);
}

TEST_F(TaskGait, ClimbsASlope) {
  constexpr double slope = 0.26;
  // The whole scene turned about the origin: what stood on the floor stands on the slope.
  const Eigen::Matrix3d turn = rotation_from_rpy({0.0, -slope, 0.0});
  const Eigen::Vector3d base = turn * base_position(read(kGaitFile).problem.start_configuration());
  const Eigen::Vector3d normal = turn.col(2);
  const std::string scene = fmt::format(
      "[[surface]]\nname = \"slope\"\nnormal = [{}, {}, {}]\n"
      "[start]\nbase_rpy_rad = [0, {}, 0]\nbase_position_m = [{}, {}, {}]\n[cost]",
      normal.x(), normal.y(), normal.z(), -slope, base.x(), base.y(), base.z());
  const MotionProblem problem = read(test::replaced(kGaitFile, "[cost]", scene)).problem;
  const BoundaryConstraint& goal = problem.boundary_constraints.at(1);
  const Eigen::Vector3d moved = base_position(goal.q_ref) - base_position(problem.start_configuration());
  EXPECT_NEAR((moved - 0.6 * turn.col(0)).norm(), 0.0, 1e-12);
  EXPECT_GT(moved.z(), 0.1);
  EXPECT_TRUE(base_rotation(goal.q_ref).isApprox(turn, 1e-12)) << "turned as at the start";
}

TEST_F(TaskGait, TakesAllItsKeys) {
  const Task task = read(R"(robot = "hyq.toml"
[[surface]]
name = "wall"
point_m = [-2, 0, 0]
normal = [1, 0, 0]
[[surface]]
name = "ground"
[gait]
kind = "walk"
strides = 1
stride_s = [2, 3]
stride_length_m = 0
duty_factor = 0.75
start_s = 0.3
settle_s = 0.7
surface = "ground"
intervals_per_second = 20
)");
  const MotionProblem& problem = task.problem;
  ASSERT_EQ(problem.phases.size(), 6u);
  EXPECT_EQ(problem.phases[0].duration.min, 0.3);
  EXPECT_EQ(problem.phases[5].duration.max, 0.7);
  EXPECT_EQ(problem.phases[1].duration.min, 0.5);
  EXPECT_EQ(problem.phases[1].duration.max, 0.75);
  EXPECT_TRUE(task.has_intervals);
  EXPECT_EQ(task.mesh.phases[1].intervals(), 15);
  EXPECT_EQ(problem.phases[1].contacts[0].surface, 1);
}

TEST_F(TaskGait, OverridesShareOutItsIntervals) {
  const std::string with_rate = test::replaced(kGaitFile, "strides = 3", "strides = 3\nintervals_per_second = 50");
  const Task task = read(with_rate, test::kHyqFile, {.intervals = 352});
  EXPECT_EQ(task.file_intervals.size(), task.problem.phases.size());
  int intervals = 0;
  for (const int count : task.file_intervals) intervals += count;
  EXPECT_EQ(intervals, 25 + 3 * (2 * 16 + 2 * 4) - 4 + 25);
  EXPECT_EQ(task.mesh.phases[1].intervals(), 34) << "of 166 in all 16 are this phase's";
  EXPECT_EQ(task.problem.boundary_constraints[1].at, PhaseFraction::end_of(12));
}

TEST_F(TaskGait, RefusesPhasesBesideIt) {
  EXPECT_EQ(message("[cost]", "[[phase]]\ncontacts = \"all\"\nduration_s = 1\nintervals = 2\n[cost]"),
            "task.toml:2:1: gait: the file also has [[phase]]; need one of the two");
}

TEST_F(TaskGait, RefusesAGoalOfItsOwnBesideGoals) {
  const std::string goal = "[[goal]]\nphase = \"settle\"\nbase_displacement_m = [0, 0, 0]\n[cost]";
  EXPECT_EQ(message("[cost]", goal),
            "task.toml:6:19: gait.stride_length_m: has no effect beside [[goal]], which sets the "
            "target; need one of the two");
  EXPECT_EQ(
      message("stride_length_m = 0.2\n", ""),
      "task.toml:2:1: gait.stride_length_m: missing; need number >= 0 [m]: distance that the base moves along the "
      "surface in each stride, in place of a speed; not with [[goal]]");
}

TEST_F(TaskGait, FollowsFromKindAndSpeedAlone) {
  const Task task = read(
      test::replaced(test::replaced(kGaitFile, "stride_s = 0.8\n", ""), "stride_length_m = 0.2", "speed_mps = 0.5"));
  const GaitPattern& trot = gait_patterns()[1];
  const double height = task.problem.robot.nominal_configuration()(2), stride = trot.default_stride(height, 0.5);
  EXPECT_NEAR(stride, 3.2 * std::sqrt(height / RobotModel::kGravity), 1e-12);
  EXPECT_NEAR(task.problem.phases[1].duration.min, (1.0 - trot.fast_duty_factor) * stride, 1e-12);
  const Eigen::VectorXd moved =
      difference(task.problem.start_configuration(), task.problem.boundary_constraints[1].q_ref);
  EXPECT_NEAR(moved(0), 3 * 0.5 * stride, 1e-12);
}

TEST_F(TaskGait, TurnsTheBaseWithItsWay) {
  const Task task = read(test::replaced(kGaitFile, "strides = 3", "strides = 3\nturn_rad = 0.2"));
  const Eigen::VectorXd moved =
      difference(task.problem.start_configuration(), task.problem.boundary_constraints[1].q_ref);
  EXPECT_NEAR(moved(5), 0.6, 1e-12);
  EXPECT_NEAR(std::atan2(moved(1), moved(0)), 0.3, 1e-12) << "half of it: the chord of an arc";
  EXPECT_NEAR(moved.head<2>().norm(), 0.6 * std::sin(0.3) / 0.3, 1e-12);
  EXPECT_EQ(message("strides = 3", "strides = 3\nturn_rad = 1.1"),
            "task.toml:5:12: gait.turn_rad: 3 strides turn the base by 3.3 rad; need at most 3 in all");
}

TEST_F(TaskGait, RefusesASpeedBesideALength) {
  EXPECT_EQ(
      message("strides = 3", "strides = 3\nspeed_mps = 0.2"),
      "task.toml:7:19: gait.stride_length_m: gait.speed_mps sets the length of a stride, too; need one of the two");
}

TEST_F(TaskGait, RefusesWhatIsNoGait) {
  EXPECT_EQ(
      message("\"trot\"", "\"trott\""),
      "task.toml:3:8: gait.kind: unknown gait \"trott\"; did you mean 'trot'? Known: walk, trot, pace, bound, pronk");
  EXPECT_THAT(message("\"trot\"", "\"trott\"\nduty_factor = 0.55"), Not(HasSubstr("duty_factor")))
      << "right for a trot";
  EXPECT_THAT(message("strides = 3", "strides = 0"), StartsWith("task.toml:4:11: gait.strides: 0 is not allowed"));
  EXPECT_THAT(message("stride_s = 0.8", "stride_s = [0.9, 0.8]"),
              StartsWith("task.toml:5:12: gait.stride_s: min > max is not allowed"));
  EXPECT_THAT(message("stride_s = 0.8", "stride_s = 0"), HasSubstr("need a number from 0.001 to 600 [s]"));
  EXPECT_EQ(message("strides = 3", "strides = 3\nduty_factor = 0.1"),
            "task.toml:5:15: gait.duty_factor: 0.1 is not allowed; need a number from 0.2 to 0.99");
  EXPECT_THAT(message("strides = 3", "strides = 3\nstrids = 1"), HasSubstr("did you mean 'strides'?"));
  EXPECT_THAT(message("stride_length_m = 0.2", "stride_length_m = -0.2"), StartsWith("task.toml:6:19: "));
}

TEST_F(TaskGait, RefusesMoreIntervalsThanFitInMemory) {
  EXPECT_EQ(message("stride_s = 0.8", "stride_s = 400\nintervals_per_second = 50"),
            "task.toml:2:1: gait: 60050 mesh intervals, 1201 s of 50 a second, are not allowed; need at most 10000");
}

TEST_F(TaskGait, RefusesAWall) {
  const std::string wall = "[[surface]]\nname = \"wall\"\nnormal = [1, 0, 0]\n[cost]";
  EXPECT_EQ(message("[cost]", wall),
            "task.toml:2:1: gait: surface 'wall' is too steep to walk on; need its normal upward");
}

TEST_F(TaskGait, RefusesARobotWithoutFourFeet) {
  folder_.write("one.toml", test::replaced(test::kHyqFile,
                                           "  { name = \"rh_foot\", frame = \"rh_foot\", radius_m = 0.02175 },\n", ""));
  EXPECT_EQ(message("hyq.toml", "one.toml"),
            "task.toml:2:1: gait: a gait needs four contacts: fore left, fore right, hind left and hind right in the "
            "nominal posture; the 3 of HyQ differ: write the phases as [[phase]]");
}

TEST_F(TaskGait, IsNamedWhereItsStartIsOffTheSurface) {
  const std::string high = "[[surface]]\nname = \"step\"\npoint_m = [0, 0, -0.1]\n[cost]";
  EXPECT_THAT(message("[cost]", high),
              StartsWith("task.toml:2:1: gait: contact 'lf_foot' of the first phase is 100.0 mm"));
}

}  // namespace
}  // namespace prowl
