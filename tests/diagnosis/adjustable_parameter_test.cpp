#include "prowl/diagnosis/adjustable_parameter.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/diagnosis/joint_parameters.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/small_robot.hpp"
#include "tests/support/standing_problem.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::Contains;

MotionProblem shipped(const std::string& task) {
  return read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/" + task + ".toml", test::test_search(), {}).problem;
}

const AdjustableParameter& parameter(const std::vector<AdjustableParameter>& parameters, const std::string& kind,
                                     int phase = -1) {
  const auto found = std::ranges::find_if(
      parameters, [&](const AdjustableParameter& one) { return one.kind == kind && one.phase == phase; });
  EXPECT_NE(found, parameters.end()) << kind << " " << phase;
  return *found;
}

const AdjustableParameter& shorter_phase(const std::vector<AdjustableParameter>& parameters, int phase) {
  const auto is_shorter = [phase](const AdjustableParameter& one) {
    return one.kind == "duration" && one.phase == phase && one.value(1.0) < one.value(0.0);
  };
  const auto found = std::ranges::find_if(parameters, is_shorter);
  EXPECT_NE(found, parameters.end()) << phase;
  return *found;
}

constexpr double kAmount = 0.4;
const double kUp = std::exp(kAmount), kDown = std::exp(-kAmount);

TEST(AdjustableParameter, OfNothingChangesNothing) {
  const MotionProblem step = shipped("hyq/step");
  const std::vector<AdjustableParameter> parameters = adjustable_parameters(step);
  EXPECT_GE(parameters.size(), 10u);
  for (const AdjustableParameter& one : parameters) {
    const MotionProblem same = one.problem(0.0);
    EXPECT_NO_THROW(validate(same)) << one.kind;
    EXPECT_EQ(same.surfaces.front().friction, step.surfaces.front().friction);
    EXPECT_EQ(same.swing_clearance, step.swing_clearance);
    EXPECT_TRUE(same.robot.torque_limit().isApprox(step.robot.torque_limit()));
    EXPECT_TRUE(same.robot.position_lower().isApprox(step.robot.position_lower()));
    EXPECT_TRUE(same.robot.velocity_limit().isApprox(step.robot.velocity_limit()));
    EXPECT_TRUE(same.boundary_constraints.back().q_ref.isApprox(step.boundary_constraints.back().q_ref));
    EXPECT_LT((*same.phases[2].contacts[0].foothold - *step.phases[2].contacts[0].foothold).norm(), 1e-12);
    for (std::size_t p = 0; p < step.phases.size(); ++p)
      EXPECT_EQ(same.phases[p].duration.max, step.phases[p].duration.max);
  }
}

TEST(AdjustableParameter, IsToldWithThreeDigitsAndALittleMore) {
  const MotionProblem step = shipped("hyq/step");
  for (const AdjustableParameter& one : adjustable_parameters(step)) {
    const double amount = printable_amount(one, kAmount), value = one.value(amount);
    EXPECT_NEAR(value / std::stod(fmt::format("{:.3g}", value)), 1.0, 1e-9) << one.kind;
    EXPECT_GE(amount, kAmount - 1e-8) << one.kind;
    EXPECT_LT(amount, kAmount + 0.011) << one.kind << ": 1.01 for 1.001 is the worst that three digits do";
    EXPECT_NEAR(printable_amount(one, amount), amount, 1e-8) << one.kind << ": it is told as it is already";
  }
}

/// In the terms of the file, where the number that is turned is none of them.
TEST(AdjustableParameter, OfAGoalTellsWhereItIs) {
  MotionProblem stand = shipped("hyq/stand");
  BoundaryConstraint& goal = stand.boundary_constraints.back();
  const int nu = stand.robot.nu();
  goal.configuration_lower.head(6).setConstant(-std::numeric_limits<double>::infinity());
  goal.configuration_upper.head(6).setConstant(std::numeric_limits<double>::infinity());
  goal.configuration_lower.tail(nu).setZero();
  goal.configuration_upper.tail(nu).setZero();
  goal.q_ref.tail(nu) = stand.start_configuration().tail(nu);
  goal.q_ref(7 + 2) += 1.0;
  const AdjustableParameter of_joint = parameter(adjustable_parameters(stand), "goal", 0);
  const double start = stand.start_configuration()(7 + 2), half = std::log(2.0);
  EXPECT_EQ(of_joint.words(0.0), fmt::format("{:.6g} rad (1 rad from the start)", start + 1.0));
  EXPECT_EQ(of_joint.words(half), fmt::format("{:.6g} rad (0.5 rad from the start)", start + 0.5));
  EXPECT_EQ(of_joint.besides(half), "");
  EXPECT_NEAR(of_joint.problem(half).boundary_constraints.back().q_ref(7 + 2), start + 0.5, 1e-12);
  goal.q_ref(7 + 1) += 0.1;
  EXPECT_EQ(parameter(adjustable_parameters(stand), "goal", 0).besides(half),
            "the whole goal 0.5 times as far from the start");
}

/// A range that is cut where its torque is not known is told as it is.
TEST(AdjustableParameter, OfARangeTellsBothBounds) {
  const MotionProblem step = shipped("hyq/step");
  const int knee = 2;
  ASSERT_FALSE(step.robot.description().limits.at(step.robot.joint_names()[knee]).torque_over_position.empty());
  const AdjustableParameter range = joint_parameter(step, LimitKind::joint_position, {knee});
  const RobotModel wider = range.problem(2.0).robot;
  EXPECT_EQ(range.words(2.0),
            fmt::format("[{:.6g}, {:.6g}] rad", wider.position_lower()(knee), wider.position_upper()(knee)));
  EXPECT_NEAR(range.value(2.0), wider.position_upper()(knee) - wider.position_lower()(knee), 1e-12);
}

/// Who turns the torque limit alone still has a table in the way; and a range is no wider than a table.
TEST(AdjustableParameter, OfJointsTellsWhatTheirTablesNeed) {
  const MotionProblem step = shipped("hyq/step");
  const double twice = std::log(2.0);
  const int hip = 0, knee = 2;
  EXPECT_EQ(joint_parameter(step, LimitKind::torque, {hip}).besides(twice), "");
  EXPECT_EQ(joint_parameter(step, LimitKind::torque, {knee}).besides(twice), "and torque_over_position times 2");
  EXPECT_EQ(parameter(adjustable_parameters(step), "torque").besides(twice), "and torque_over_position times 2");
  const AdjustableParameter ranges = joint_parameter(step, LimitKind::joint_position, {hip, knee});
  const RobotModel wider = ranges.problem(twice).robot;
  const auto width = [](const RobotModel& robot, int j) {
    return robot.position_upper()(j) - robot.position_lower()(j);
  };
  EXPECT_NEAR(width(wider, hip), 2.0 * width(step.robot, hip), 1e-12);
  ASSERT_LT(width(wider, knee), 1.9 * width(step.robot, knee));
  EXPECT_EQ(ranges.besides(twice),
            fmt::format("but within torque_over_position {} [{:.6g}, {:.6g}] rad", step.robot.joint_names()[knee],
                        wider.position_lower()(knee), wider.position_upper()(knee)));
  EXPECT_EQ(joint_parameter(step, LimitKind::joint_position, {hip, hip + 1}).besides(twice), "");
}

TEST(AdjustableParameter, TurnsTheNumberThatItTellsOf) {
  const MotionProblem step = shipped("hyq/step");
  const std::vector<AdjustableParameter> parameters = adjustable_parameters(step);
  for (const AdjustableParameter& one : parameters)
    EXPECT_NEAR(std::abs(std::log(one.value(kAmount) / one.value(0.0))), kAmount, 1e-12) << one.kind;

  EXPECT_NEAR(parameter(parameters, "friction").problem(kAmount).surfaces[0].friction, 0.5 * kUp, 1e-12);
  EXPECT_TRUE(
      parameter(parameters, "torque").problem(kAmount).robot.torque_limit().isApprox(kUp * step.robot.torque_limit()));
  EXPECT_NEAR(parameter(parameters, "torque").problem(kAmount).robot.torque_upper(2, -1.4, 0.0),
              kUp * step.robot.torque_upper(2, -1.4, 0.0), 1e-9)
      << "a curve over the position, too";
  EXPECT_TRUE(parameter(parameters, "joint_velocity")
                  .problem(kAmount)
                  .robot.velocity_limit()
                  .isApprox(kUp * step.robot.velocity_limit()));
  EXPECT_NEAR(parameter(parameters, "clearance").problem(kAmount).swing_clearance, kDown * step.swing_clearance, 1e-12);

  const MotionProblem longer = parameter(parameters, "duration", 1).problem(kAmount);
  EXPECT_NEAR(longer.phases[1].duration.max, 0.8 * kUp, 1e-12);
  EXPECT_EQ(longer.phases[1].duration.min, 0.4);
  EXPECT_EQ(longer.phases[0].duration.max, 1.5);

  const MotionProblem nearer = parameter(parameters, "goal", 2).problem(kAmount);
  EXPECT_NEAR(nearer.boundary_constraints[1].q_ref(0) - step.start_configuration()(0), kDown * 0.05, 1e-12);
  const MotionProblem shorter = parameter(parameters, "place", 2).problem(kAmount);
  EXPECT_NEAR(0.5708 - shorter.phases[2].contacts[0].foothold->x(), (1.0 - kDown) * 0.2, 1e-3) << "a step of 20 cm";
  EXPECT_EQ(shorter.phases[2].contacts[0].foothold->z(), 0.0) << "on the floor";
}

/// As a task file says it.
TEST(AdjustableParameter, OfAFootholdTellsItsCoordinates) {
  const MotionProblem step = shipped("hyq/step");
  const AdjustableParameter foothold = parameter(adjustable_parameters(step), "place", 2);
  EXPECT_EQ(foothold.words(0.0), "[0.5708, 0.3241, 0] m (0.2 m from its previous position)");
  EXPECT_THAT(
      foothold.words(std::log(2.0)),
      testing::AllOf(testing::StartsWith("[0.4707"), testing::EndsWith(", 0] m (0.1 m from its previous position)")));
}

/// The limit itself where there is but one.
TEST(AdjustableParameter, OfSeveralJointsIsAFactor) {
  const MotionProblem step = shipped("hyq/step");
  EXPECT_TRUE(parameter(adjustable_parameters(step), "torque").is_factor);
  EXPECT_TRUE(joint_parameter(step, LimitKind::torque, {0, 1}).is_factor);
  const AdjustableParameter one = joint_parameter(step, LimitKind::torque, {0});
  EXPECT_FALSE(one.is_factor);
  EXPECT_EQ(one.value(0.0), step.robot.torque_limit()(0));
  RobotDescription leg{.name = "hopper"};
  leg.urdf_text = test::chain_urdf(1);
  leg.contacts = {{"tip", "l1"}};
  const MotionProblem hopper = test::standing_problem(RobotModel(leg));
  const std::vector<AdjustableParameter> parameters = adjustable_parameters(hopper);
  EXPECT_FALSE(parameter(parameters, "torque").is_factor);
  EXPECT_EQ(parameter(parameters, "torque").subject, hopper.robot.joint_names()[0]) << "all joints are this one";
}

/// The torque over it is not known beyond.
TEST(AdjustableParameter, OfAVelocityLimitEndsWhereACurveDoes) {
  MotionProblem step = shipped("hyq/step");
  RobotDescription robot = step.robot.description();
  const double limit = step.robot.velocity_limit()(1);
  robot.limits[step.robot.joint_names()[1]].torque_over_velocity = {
      {-limit, 100.0}, {0.0, 100.0}, {0.5 * limit, 80.0}, {limit, 50.0}};
  step.robot = RobotModel(robot);
  using testing::Not;
  EXPECT_THAT(turnable_joints(step.robot, LimitKind::joint_velocity), Not(Contains(1)));
  EXPECT_THAT(turnable_joints(step.robot, LimitKind::torque), Contains(1));
}

TEST(AdjustableParameter, OfARangeWidensItBothWays) {
  const MotionProblem stand = shipped("solo12/stand");
  const MotionProblem wider = joint_parameter(stand, LimitKind::joint_position, {8}).problem(kAmount);
  const double range = stand.robot.position_upper()(8) - stand.robot.position_lower()(8);
  EXPECT_NEAR(wider.robot.position_upper()(8) - wider.robot.position_lower()(8), kUp * range, 1e-12);
  EXPECT_LT(wider.robot.position_lower()(8), stand.robot.position_lower()(8));
  EXPECT_EQ(wider.robot.position_upper()(7), stand.robot.position_upper()(7)) << "of that joint only";
}

/// What is farthest away by the robot's size, with its name and unit.
TEST(AdjustableParameter, OfAGoalNamesWhatIsFarthestAway) {
  MotionProblem step = shipped("hyq/step");
  BoundaryConstraint& goal = step.boundary_constraints.back();
  EXPECT_EQ(parameter(adjustable_parameters(step), "goal", 2).unit, "m");
  goal.velocity_lower(7) = goal.velocity_upper(7) = 5.0;
  const AdjustableParameter of_joint = parameter(adjustable_parameters(step), "goal", 2);
  EXPECT_THAT(of_joint.subject, testing::EndsWith(", velocity of " + step.robot.joint_names()[1]));
  EXPECT_EQ(of_joint.unit, "rad/s");
  EXPECT_EQ(of_joint.value(0.0), 5.0);
  goal.velocity_lower(7) = goal.velocity_upper(7) = 0.2;
  EXPECT_EQ(parameter(adjustable_parameters(step), "goal", 2).unit, "m") << "5 cm are more than 0.2 rad/s";
}

/// Rubber on dry concrete has 0.8.
TEST(AdjustableParameter, OfFrictionGoesNoFurtherThanRubber) {
  MotionProblem step = shipped("hyq/step");
  for (const double friction : {0.5, 0.79}) {
    step.surfaces[0].friction = friction;
    const std::vector<AdjustableParameter> parameters = adjustable_parameters(step);
    const AdjustableParameter& up = parameter(parameters, "friction");
    EXPECT_NEAR(up.value(up.most), 0.8, 1e-12);
  }
  step.surfaces[0].friction = 0.9;
  const auto is_friction = [](const AdjustableParameter& one) { return one.kind == "friction"; };
  EXPECT_TRUE(std::ranges::none_of(adjustable_parameters(step), is_friction));
}

/// From where: after a landing that the optimiser chooses, nobody knows before the solve.
TEST(AdjustableParameter, OfAFootholdNeedsToKnowWhereTheContactWas) {
  MotionProblem walk = shipped("hyq/step");
  walk.phases.push_back(walk.phases[1]);
  walk.phases.push_back(walk.phases[2]);
  const auto footholds = [&] {
    return std::ranges::count_if(adjustable_parameters(walk),
                                 [](const AdjustableParameter& one) { return one.kind == "place"; });
  };
  EXPECT_EQ(footholds(), 2);
  walk.phases[2].contacts[0].foothold.reset();
  EXPECT_EQ(footholds(), 0);
}

/// What is proposed has to be what a task file may ask for: 600 s in all, and a millisecond a phase.
TEST(AdjustableParameter, OfADurationIsOneThatATaskMayHave) {
  MotionProblem step = shipped("hyq/step");
  for (Phase& phase : step.phases) phase.duration = {40.0, 40.0};
  const double others = 40.0 * static_cast<double>(step.phases.size() - 1);
  const std::vector<AdjustableParameter> parameters = adjustable_parameters(step);
  const AdjustableParameter& one = parameter(parameters, "duration", 0);
  const AdjustableParameter& all = parameter(parameters, "duration");
  EXPECT_NEAR(one.value(one.most), 600.0 - others, 1e-9);
  EXPECT_NEAR(all.value(all.most), 600.0, 1e-9);

  MotionProblem jump = shipped("hyq/jump");
  jump.phases[2].duration = {0.004, 0.004};
  const std::vector<AdjustableParameter> of_jump = adjustable_parameters(jump);
  const AdjustableParameter& shorter = shorter_phase(of_jump, 2);
  EXPECT_NEAR(shorter.value(shorter.most), 0.001, 1e-12);
}

TEST(AdjustableParameter, OfAFlightMayBeShorter) {
  const MotionProblem jump = shipped("hyq/jump");
  const std::vector<AdjustableParameter> parameters = adjustable_parameters(jump);
  const AdjustableParameter& shorter = shorter_phase(parameters, 2);
  EXPECT_NEAR(shorter.problem(kAmount).phases[2].duration.min, 0.2 * kDown, 1e-12);
  EXPECT_EQ(shorter.problem(kAmount).phases[2].duration.max, 0.45);
}

}  // namespace
}  // namespace prowl
