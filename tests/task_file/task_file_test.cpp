#include "prowl/task_file/task_file.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "prowl/mesh/first_mesh.hpp"
#include "prowl/model/configuration.hpp"
#include "tests/support/task_test.hpp"

namespace prowl {
namespace {

using test::kHyqFile;
using test::kTaskFile;
using testing::HasSubstr;
using testing::StartsWith;

const double kInfinity = std::numeric_limits<double>::infinity();

class TaskFile : public test::TaskTest {
 protected:
  /// What the user sees if `from` in the right task is replaced by `to`.
  std::string message(const std::string& from, const std::string& to) {
    return message_of(test::replaced(kTaskFile, from, to));
  }
};

TEST_F(TaskFile, GivesTheProblemThatItDescribes) {
  const Task task = read(kTaskFile);
  const MotionProblem& problem = task.problem;
  EXPECT_EQ(problem.name, "shift");
  EXPECT_EQ(problem.robot.name(), "HyQ");
  ASSERT_EQ(problem.phases.size(), 1u);
  EXPECT_EQ(problem.phases[0].contacts.size(), 4u);
  EXPECT_EQ(problem.phases[0].duration.min, 2.0);
  EXPECT_EQ(task.mesh.phases[0].intervals(), 5);
  ASSERT_EQ(problem.surfaces.size(), 1u);
  EXPECT_EQ(problem.surfaces[0].friction, 0.5);
  EXPECT_EQ(problem.running_cost.torque_weight, Eigen::VectorXd::Constant(12, 1e-3));
  EXPECT_GT(problem.running_cost.tau_ref.norm(), 1.0) << "HyQ does not stand without torque";
  EXPECT_EQ(problem.start_configuration()(7), -0.1) << "lf_haa_joint is HyQ's first joint";
  EXPECT_EQ(problem.start_configuration()(8), 0.75) << "not named in [start], so nominal";
  EXPECT_EQ(task.task_file.text, kTaskFile);
}

TEST_F(TaskFile, FreeStepsAreDurationsOfTheirOwn) {
  const std::string with_steps =
      test::replaced(test::replaced(kTaskFile, "duration_s = 2.0", "duration_s = [1.0, 2.0]\nsteps = \"free\""),
                     "time_s = 2.0", "phase = \"stand\"");
  const auto goal_at = [&](const std::string& fraction) {
    return read(test::replaced(with_steps, "[start]", fraction + "\n[start]")).problem.boundary_constraints[1].at;
  };
  const Task task = read(with_steps);
  const MotionProblem& problem = task.problem;
  ASSERT_EQ(problem.phases.size(), 5u);
  ASSERT_EQ(task.mesh.phases.size(), 5u);
  for (const PhaseMesh& phase : task.mesh.phases) EXPECT_EQ(phase.intervals(), 1);
  for (const Phase& phase : problem.phases) {
    EXPECT_EQ(phase.duration.min, 0.2);
    EXPECT_EQ(phase.duration.max, 0.4);
  }
  EXPECT_EQ(problem.phases[3].name, "stand step 4");
  EXPECT_EQ(problem.boundary_constraints[1].at, PhaseFraction::end_of(4))
      << "the goal is at the end of the whole phase";
  EXPECT_EQ(goal_at("fraction = 0.4"), PhaseFraction::end_of(1));
  EXPECT_EQ(goal_at("fraction = 0"), PhaseFraction::start_of(0));
  EXPECT_EQ(read(with_steps, kHyqFile, {.intervals = 8}).problem.phases.size(), 8u);
  EXPECT_THAT(message_of(test::replaced(with_steps, "intervals = 5", "intervals = 201")),
              HasSubstr("phase[0].steps: 201 free steps are not allowed; need at most 200"));
  EXPECT_THAT(message("duration_s = 2.0", "duration_s = 2.0\nsteps = \"free\""),
              HasSubstr("steps: a fixed duration has no free steps; need duration_s = [min, max]"));
}

TEST_F(TaskFile, LeavesTheMeshToProwlWithoutIntervals) {
  const std::string file = test::replaced(kTaskFile, "intervals = 5\n", "");
  EXPECT_TRUE(read(kTaskFile).has_intervals);
  const Task task = read(file);
  EXPECT_FALSE(task.has_intervals);
  EXPECT_EQ(task.mesh, first_mesh(task.problem.phases, {}));

  const Task between = read(test::replaced(file, "time_s = 2.0", "time_s = 0.777"));
  const PhaseFraction at = between.problem.boundary_constraints[1].at;
  EXPECT_NEAR(at.fraction, 0.777 / 2.0, 1e-12);
  EXPECT_TRUE(between.mesh.phases[0].node_at(at.fraction)) << "a goal has a node at any time";
  const std::string part = test::replaced(file, "time_s = 2.0", "phase = \"stand\"\nfraction = 0.123");
  EXPECT_EQ(read(part).problem.boundary_constraints[1].at.fraction, 0.123);

  const Task chosen = read(file, kHyqFile, {.intervals = 30});
  EXPECT_TRUE(chosen.has_intervals);
  EXPECT_EQ(chosen.mesh.phases[0], PhaseMesh(30));

  EXPECT_EQ(message_of(test::replaced(file, "time_s = 2.0", "time_s = 2.5")),
            "task.toml:8:10: goal[0].time_s: 2.5 is after the end; need 0 < time <= 2 [s]");
  const std::string second = "[[phase]]\ncontacts = \"all\"\nduration_s = 1\n\n[[goal]]";
  EXPECT_THAT(message("[[goal]]", second), HasSubstr("phase[1]: no intervals, which other phases have; need all"));
  EXPECT_THAT(message_of(test::replaced(file, "duration_s = 2.0", "duration_s = [1.0, 2.0]\nsteps = \"free\"")),
              HasSubstr("phase[0].steps: free steps need the key intervals"));
}

TEST_F(TaskFile, GoalIsAtTheEndUnlessItSaysWhen) {
  EXPECT_EQ(read(test::replaced(kTaskFile, "time_s = 2.0\n", "")).problem.boundary_constraints[1].at,
            PhaseFraction::end_of(0));
}

TEST_F(TaskFile, StartIsFixedAndGoalBindsWhatIsNamed) {
  const MotionProblem problem = read(kTaskFile).problem;
  ASSERT_EQ(problem.boundary_constraints.size(), 2u);
  EXPECT_TRUE(problem.start().configuration_lower.isZero(0.0) && problem.start().configuration_upper.isZero(0.0));
  EXPECT_TRUE(problem.start().velocity_lower.isZero(0.0) && problem.start().velocity_upper.isZero(0.0));

  const BoundaryConstraint& goal = problem.boundary_constraints[1];
  EXPECT_EQ(goal.at, PhaseFraction::end_of(0));
  const Eigen::Vector3d shift = base_position(goal.q_ref) - base_position(problem.start_configuration());
  EXPECT_NEAR((shift - Eigen::Vector3d(0.05, 0.0, -0.05)).norm(), 0.0, 1e-15);
  EXPECT_EQ(goal.configuration_lower(0), 0.0);
  EXPECT_EQ(goal.configuration_upper(0), 0.0);
  EXPECT_EQ(goal.configuration_lower(1), -kInfinity);
  EXPECT_EQ(goal.configuration_upper(1), kInfinity);
  for (int i = 3; i < 18; ++i) EXPECT_EQ(goal.configuration_upper(i), kInfinity) << i;
  EXPECT_EQ(goal.velocity_lower, Eigen::VectorXd::Constant(18, -kInfinity));
}

TEST_F(TaskFile, StartsOnASurfaceTurnedWithIt) {
  const std::string slope = R"([[surface]]
name = "slope"
point_m = [1, 2, 3]
normal = [-1, 0, 2]
[start]
on = "slope")";
  const MotionProblem level = read(kTaskFile).problem;
  const MotionProblem on_slope = read(test::replaced(kTaskFile, "[start]", slope)).problem;
  const Eigen::VectorXd &q = on_slope.start_configuration(), &q_level = level.start_configuration();
  const Eigen::Vector3d normal = Eigen::Vector3d(-1, 0, 2).normalized();
  EXPECT_EQ(q.tail(12), q_level.tail(12));
  EXPECT_NEAR(on_slope.surfaces[0].distance(base_position(q)), q_level(2), 1e-12)
      << "as high above it as above level ground";
  EXPECT_NEAR((base_rotation(q) * Eigen::Vector3d::UnitZ() - normal).norm(), 0.0, 1e-12);
  EXPECT_NEAR((base_rotation(q) * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-12)
      << "no more than that";
  // Angles of a goal that are free are those of the start.
  const std::string goal = "base_rpy_rad = [\"free\", \"free\", 0]\n";
  const MotionProblem turned = read(test::replaced(kTaskFile, "[start]", goal + slope)).problem;
  EXPECT_NEAR((base_rotation(turned.boundary_constraints[1].q_ref) - base_rotation(q)).norm(), 0.0, 1e-12);

  EXPECT_THAT(message("[start]", slope + "\nbase_position_m = [0, 0, 1]"),
              HasSubstr("need either on or base_position_m"));
  EXPECT_THAT(message("[start]", "[start]\non = \"slop\""), HasSubstr("surface"));
}

TEST_F(TaskFile, GoalReadsOrientationVelocityJointsAndTorques) {
  const MotionProblem problem = read(test::replaced(kTaskFile, "[start]", R"(base_rpy_rad = [0.1, "free", 0.3]
base_angular_velocity_radps = [0, [-1, 2], "free"]
joints = { lf_kfe_joint = [-1.6, -1.4] }
joint_velocity_radps = { lf_kfe_joint = 0.5 }
torque_Nm = { lf_kfe_joint = [10, 20] }
[start])"))
                                    .problem;
  const BoundaryConstraint& goal = problem.boundary_constraints[1];
  EXPECT_TRUE(base_rotation(goal.q_ref).isApprox(rotation_from_rpy({0.1, 0.0, 0.3}), 1e-14));
  EXPECT_EQ(goal.configuration_upper(3), 0.0);
  EXPECT_EQ(goal.configuration_upper(4), kInfinity);
  EXPECT_EQ(goal.configuration_upper(5), 0.0);
  EXPECT_EQ(goal.velocity_lower(3), 0.0);
  EXPECT_EQ(goal.velocity_lower(4), -1.0);
  EXPECT_EQ(goal.velocity_upper(4), 2.0);
  EXPECT_EQ(goal.velocity_upper(5), kInfinity);
  EXPECT_EQ(goal.velocity_upper(0), kInfinity) << "the linear velocity was not named";
  // Relative to q_ref, whose joint stands at -1.5.
  EXPECT_NEAR(goal.configuration_lower(6 + 2), -0.1, 1e-14);
  EXPECT_NEAR(goal.configuration_upper(6 + 2), 0.1, 1e-14);
  EXPECT_EQ(goal.velocity_lower(6 + 2), 0.5);
  EXPECT_EQ(goal.torque_lower(2), 10.0);
  EXPECT_EQ(goal.torque_upper(2), 20.0);
  EXPECT_EQ(goal.torque_upper(1), kInfinity);
}

TEST_F(TaskFile, PhasesNameContactsAndSurfaces) {
  const std::string second = R"([[surface]]
name = "floor"
[[surface]]
name = "ice"
friction = 0.1
normal = [0, 0, 2]
[[phase]]
name = "open"
contacts = ["rh_foot"]
duration_s = 1
intervals = 2
[[phase]]
name = "three"
contacts = ["rh_foot", { contact = "lf_foot", surface = "ice" }]
duration_s = 1
intervals = 2
[[goal]]
phase = "three"
joints = { rf_kfe_joint = -1.2 }
[cost])";
  const MotionProblem problem = read(test::replaced(kTaskFile, "[cost]", second)).problem;
  ASSERT_EQ(problem.phases.size(), 3u);
  ASSERT_EQ(problem.phases[2].contacts.size(), 2u);
  EXPECT_EQ(problem.phases[2].contacts[0].contact, problem.robot.contact_index("rh_foot"));
  EXPECT_EQ(problem.phases[2].contacts[0].surface, 0);
  EXPECT_EQ(problem.phases[2].contacts[1].contact, problem.robot.contact_index("lf_foot"));
  EXPECT_EQ(problem.phases[2].contacts[1].surface, 1);
  EXPECT_NEAR(problem.surfaces[1].normal.norm(), 1.0, 1e-15);
  EXPECT_EQ(problem.boundary_constraints[2].at, PhaseFraction::end_of(2));
}

TEST_F(TaskFile, TrackingReplacesTheRobotsDefaults) {
  const Task plain = read(kTaskFile);
  const TrackingOptions defaults = default_tracking_options(plain.problem.robot);
  EXPECT_EQ(plain.tracking.state_deviation, defaults.state_deviation);
  EXPECT_EQ(plain.tracking.torque_deviation, defaults.torque_deviation);

  const TrackingOptions tracking = read(kTaskFile + R"(
[tracking]
step_s = 0.004
base_position_m = [0.01, 0.02, 0.03]
base_orientation_rad = 0.05
joint_position_rad = { lf_hfe_joint = 0.3 }
base_linear_velocity_mps = 0.5
base_angular_velocity_radps = [1, 2, 3]
joint_velocity_radps = 7
torque_share = 0.2
swing_foot_m = 0.03
landing_s = 0
goal_s = 0.5
bandwidth_radps = 60
)")
                                       .tracking;
  EXPECT_EQ(tracking.step, 0.004);
  EXPECT_EQ(tracking.swing_foot_deviation, 0.03);
  EXPECT_EQ(tracking.landing_time, 0.0);
  EXPECT_EQ(tracking.goal_time, 0.5);
  EXPECT_EQ(tracking.largest_bandwidth, 60.0);
  Eigen::VectorXd expected(36);
  expected << 0.01, 0.02, 0.03, Eigen::Vector3d::Constant(0.05), defaults.state_deviation.segment(6, 12),
      Eigen::Vector3d::Constant(0.5), 1.0, 2.0, 3.0, Eigen::VectorXd::Constant(12, 7.0);
  expected(7) = 0.3;
  EXPECT_EQ(tracking.state_deviation, expected);
  EXPECT_LT((tracking.torque_deviation - 2.0 * defaults.torque_deviation).norm(), 1e-12);
}

TEST_F(TaskFile, RefusesTrackingThatMakesNoSense) {
  for (const char* line :
       {"base_position_m = 0", "joint_position_rad = -1", "step_s = 1", "torque_share = 0", "swing_foot_m = 0",
        "landing_s = -1", "goal_s = -1", "bandwidth_radps = 0", "stiffness = 3", "joint_position_rad = { nose = 1 }"}) {
    const std::string key = std::string(line).substr(0, std::string(line).find(' '));
    EXPECT_THAT(message_of(kTaskFile + "\n[tracking]\n" + line + "\n"), HasSubstr(key)) << line;
  }
}

TEST_F(TaskFile, RobustSizesReplaceThoseOfTheSweep) {
  EXPECT_FALSE(read(kTaskFile).robust.has_value());
  const Disturbances defaults = default_disturbances(read(kTaskFile).problem.robot);
  const auto asked = read(kTaskFile, kHyqFile, {.robust = true}).robust, table = read(kTaskFile + "[robust]\n").robust;
  ASSERT_TRUE(asked && table);
  EXPECT_EQ(asked->push, defaults.push);
  EXPECT_EQ(table->center, defaults.center);
  const auto own = read(kTaskFile + "[robust]\nbase_position_m = 0.03\nmass = 0.2\npush_mps = 0.5\n").robust;
  ASSERT_TRUE(own);
  EXPECT_EQ(own->base_position, 0.03);
  EXPECT_EQ(own->mass, 0.2);
  EXPECT_EQ(own->push, 0.5);
  EXPECT_EQ(own->friction, defaults.friction);
}

TEST_F(TaskFile, RefusesRobustSizesOutOfRange) {
  for (const char* line : {"mass = 1", "friction = -0.1", "push_mps = 3", "push_s = 0", "center_m = 0.3", "wind = 1"}) {
    const std::string key = std::string(line).substr(0, std::string(line).find(' '));
    EXPECT_THAT(message_of(kTaskFile + "\n[robust]\n" + line + "\n"), HasSubstr(key)) << line;
  }
}

TEST_F(TaskFile, OverridesReplaceTheFilesValues) {
  const Task task =
      read(kTaskFile, kHyqFile, {.intervals = 40, .max_iterations = 7, .max_seconds = 1.5, .tolerance = 1e-9});
  EXPECT_EQ(task.mesh.phases[0].intervals(), 40);
  EXPECT_EQ(task.problem.boundary_constraints[1].at, PhaseFraction::end_of(0)) << "the goal stays at its time";
  EXPECT_EQ(task.solver.max_iterations, 7);
  EXPECT_EQ(task.solver.tolerance, 1e-9);
  EXPECT_EQ(task.solver.max_seconds, 1.5);
}

TEST_F(TaskFile, NamesTheKeyOfAFootholdOffItsSurface) {
  EXPECT_EQ(message("\"all\"", "[{ contact = \"lf_foot\", place_m = [0, 0, 0.1] }]"),
            "task.toml:5:46: phase[0].contacts[0].place_m: 100.0 mm above surface 'floor' is not allowed; need a place "
            "on it");
}

TEST_F(TaskFile, SlugTellsTasksOfDifferentRobotsApart) {
  EXPECT_EQ(task_slug("tasks/hyq/crouch.toml"), "hyq_crouch");
  EXPECT_EQ(task_slug("tasks/go2/../solo12/crouch.toml"), "solo12_crouch");
}

// What a new user is most likely to get wrong, with the whole message.

TEST_F(TaskFile, RefusesUnknownKey) {
  EXPECT_EQ(message("duration_s", "duration"),
            "task.toml:6:1: phase[0].duration: unknown key; did you mean 'duration_s'? "
            "Known: name, contacts, duration_s, intervals, steps");
}

TEST_F(TaskFile, RefusesWrongUnit) {
  EXPECT_THAT(message("[start]", "base_rpy_deg = [0, 10, 0]\n[start]"),
              StartsWith("task.toml:11:1: goal[0].base_rpy_deg: unknown key; did you mean 'base_rpy_rad'? Known: "));
  EXPECT_EQ(message("[start]", "base_rpy_rad = [0, 10, 0]\n[start]"),
            "task.toml:11:20: goal[0].base_rpy_rad[1]: 10 is not allowed; need a number from -6.2832 to 6.2832 [rad]; "
            "5 degrees are 0.087");
}

TEST_F(TaskFile, RefusesMissingRobotFile) {
  EXPECT_EQ(message("hyq.toml", "robots/hyq.toml"), "task.toml:2:9: robot: no such file: robots/hyq.toml");
  EXPECT_EQ(message("robot = \"hyq.toml\"\n", ""),
            "task.toml:1:1: robot: missing; need path: robot file, relative to this file");
}

TEST_F(TaskFile, RefusesUnknownContact) {
  EXPECT_EQ(message("\"all\"", "[\"lf_foot\", \"rf_fot\"]"),
            "task.toml:5:24: phase[0].contacts[1]: unknown contact \"rf_fot\"; did you mean 'rf_foot'? "
            "Known: lf_foot, rf_foot, lh_foot, rh_foot");
  EXPECT_EQ(message("\"all\"", "[\"lf_foot\", \"lf_foot\"]"),
            "task.toml:5:24: phase[0].contacts[1]: this contact is in the list twice");
}

TEST_F(TaskFile, RefusesUnknownSurface) {
  EXPECT_EQ(
      message("\"all\"", "[{ contact = \"lf_foot\", surface = \"flor\" }]"),
      "task.toml:5:46: phase[0].contacts[0].surface: unknown surface \"flor\"; did you mean 'floor'? Known: floor");
}

TEST_F(TaskFile, RefusesWrongType) {
  EXPECT_EQ(message("2.0\nintervals", "\"2 s\"\nintervals"),
            "task.toml:6:14: phase[0].duration_s: \"2 s\" is not allowed; need a number from 0.001 to 600 [s]");
  EXPECT_EQ(message("intervals = 5", "intervals = 5.0"),
            "task.toml:7:13: phase[0].intervals: 5 is not allowed; need an integer from 1 to 10000, without a point");
  EXPECT_EQ(message("[[phase]]", "[phase]"),
            "task.toml:3:1: phase: a table is not allowed; need one [[phase]] for each");
}

TEST_F(TaskFile, RefusesNegativeAndZeroDuration) {
  EXPECT_EQ(message("2.0\nintervals", "-2.0\nintervals"),
            "task.toml:6:14: phase[0].duration_s: -2 is not allowed; need a number from 0.001 to 600 [s]");
  EXPECT_EQ(message("2.0\nintervals", "0\nintervals"),
            "task.toml:6:14: phase[0].duration_s: 0 is not allowed; need a number from 0.001 to 600 [s]");
}

/// Milliseconds, mostly; and the certificate of what is left takes seconds.
TEST_F(TaskFile, RefusesMotionsOfMoreThanTenMinutes) {
  EXPECT_EQ(message("2.0\nintervals", "2000\nintervals"),
            "task.toml:6:14: phase[0].duration_s: 2000 is not allowed; need a number from 0.001 to 600 [s]");
  EXPECT_THAT(message("[[phase]]",
                      "[[phase]]\nname = \"wait\"\ncontacts = \"all\"\nduration_s = 599\nintervals = 5\n\n[[phase]]"),
              HasSubstr("phases of 601 s in all are not allowed; need at most 600 s"));
}

TEST_F(TaskFile, DurationMayBeFreeWithinBounds) {
  const std::string free = test::replaced(test::replaced(kTaskFile, "2.0\nintervals", "[1.0, 3.0]\nintervals"),
                                          "time_s = 2.0", "phase = \"stand\"");
  EXPECT_EQ(read(free).problem.phases[0].duration.min, 1.0);
  EXPECT_EQ(read(free).problem.phases[0].duration.max, 3.0);
  EXPECT_EQ(message("2.0\nintervals", "[3.0, 1.0]\nintervals"),
            "task.toml:6:14: phase[0].duration_s: min > max is not allowed; need [min, max]");
  EXPECT_EQ(message("2.0\nintervals", "[1.0, 3.0]\nintervals"),
            "task.toml:9:10: goal[0].time_s: the duration of phase 'stand' is free: need phase, not time_s");
}

TEST_F(TaskFile, RefusesGoalsThatTheRobotCannotDo) {
  EXPECT_EQ(message("[start]", "joints = { lf_kfe_joint = -3.0 }\n[start]"),
            "task.toml:11:27: goal[0].joints.lf_kfe_joint: outside the joint's position limits; need a value from "
            "-2.4435 to -0.34907");
  EXPECT_EQ(message("[start]", "joint_velocity_radps = { lf_kfe_joint = [13, 14] }\n[start]"),
            "task.toml:11:41: goal[0].joint_velocity_radps.lf_kfe_joint: outside the joint's velocity limits; need a "
            "value from -12 to 12");
  EXPECT_THAT(message("[start]", "torque_Nm = { lf_kfe_joint = -151 }\n[start]"),
              HasSubstr("outside the joint's torque limits; need a value from -150 to 150"));
  EXPECT_EQ(message("[start]", "joint_velocity_radps = { lf_kfe_joint = [11, 14] }\n[start]"), "") << "leaves 11 to 12";
}

TEST_F(TaskFile, RefusesAGoalThatBindsNothing) {
  EXPECT_EQ(message("base_displacement_m = [0.05, \"free\", -0.05]\n", ""),
            "task.toml:8:1: goal[0]: constrains nothing; need at least one key that prescribes or bounds a value");
  EXPECT_THAT(message("[0.05, \"free\", -0.05]", "[\"free\", \"free\", \"free\"]"), HasSubstr("constrains nothing"));
}

TEST_F(TaskFile, RefusesNumbersBeyondAllSense) {
  const std::string surface = "[[surface]]\nname = \"wall\"\nnormal = ";
  EXPECT_EQ(message("[cost]", surface + "[0, 0, 1e200]\n[cost]"),
            "task.toml:15:17: surface[0].normal[2]: 1e+200 is not allowed; need a number of at most 1e+09 in size");
  EXPECT_EQ(message("[cost]", surface + "[0, 0, 1e-200]\n[cost]"),
            "task.toml:15:10: surface[0].normal: too short for a direction; need a length of 1e-06 or more");
}

TEST_F(TaskFile, RefusesNamesThatBreakFiles) {
  EXPECT_THAT(message("\"shift\"", "\"a\\nb\""),
              StartsWith("task.toml:1:8: name: this name is not allowed; need at most 200 printable ASCII"));
  EXPECT_THAT(message("\"stand\"", "\"a,b\""), StartsWith("task.toml:4:8: phase[0].name: this name is not allowed"));
}

TEST_F(TaskFile, NameOfTheFileStandsForTheName) {
  folder_.write("hyq.toml", kHyqFile);
  const auto file = folder_.write("a,b\xff.toml", test::replaced(kTaskFile, "name = \"shift\"\n", ""));
  EXPECT_EQ(read_task_file(file, test::test_search()).problem.name, "a_b_");
}

TEST_F(TaskFile, TellsARobotFile) {
  EXPECT_EQ(message_of(kHyqFile),
            "task.toml:2:8: urdf: this looks like a robot file; need a task file, which names its robot file with "
            "robot = \"...\"");
}

TEST_F(TaskFile, RefusesNotANumber) {
  EXPECT_EQ(message("torque = 1e-3", "torque = nan"),
            "task.toml:14:10: cost.torque: nan is not allowed; need a finite number >= 0 [1/(N m)²]");
  EXPECT_EQ(message("torque = 1e-3", "torque = inf"),
            "task.toml:14:10: cost.torque: inf is not allowed; need a finite number >= 0 [1/(N m)²]");
  EXPECT_EQ(message("[0.05,", "[nan,"),
            "task.toml:10:24: goal[0].base_displacement_m[0]: nan is not allowed; need a finite number [m]");
}

TEST_F(TaskFile, RefusesGoalBetweenNodes) {
  EXPECT_EQ(message("time_s = 2.0", "time_s = 1.0"),
            "task.toml:9:10: goal[0].time_s: 1 is not at a node of the mesh; the nearest are 0.8 and 1.2 [s]");
  EXPECT_EQ(message("time_s = 2.0", "time_s = 2.5"),
            "task.toml:9:10: goal[0].time_s: 2.5 is after the end; need 0 < time <= 2 [s]");
  EXPECT_EQ(message("time_s = 2.0", "phase = \"stnd\""),
            "task.toml:9:9: goal[0].phase: unknown phase \"stnd\"; did you mean 'stand'? Known: stand");
}

TEST_F(TaskFile, RefusesStartOutsideItsLimits) {
  EXPECT_EQ(message("lf_haa_joint = -0.1", "lf_haa_joint = -1.5"),
            "task.toml:12:27: start.joints.lf_haa_joint: the start posture has -1.5 rad, outside the joint's limits "
            "[-1.22173, 0.436332]");
  const std::string robot = test::replaced(kHyqFile, "rh_kfe_joint = 1.5", "rh_kfe_joint = 3.0");
  EXPECT_THAT(message_of(kTaskFile, robot),
              StartsWith("hyq.toml:21:16: nominal.joints.rh_kfe_joint: the start posture has 3 rad, outside"));
}

TEST_F(TaskFile, RefusesUnknownJoint) {
  EXPECT_THAT(
      message("lf_haa_joint = -0.1", "lf_haa_jont = -0.1"),
      StartsWith("task.toml:12:12: start.joints.lf_haa_jont: unknown joint; did you mean 'lf_haa_joint'? Known: "));
}

TEST_F(TaskFile, RefusesDuplicateKey) {
  EXPECT_THAT(message("intervals = 5", "intervals = 5\nintervals = 10"), StartsWith("task.toml:8:"));
  EXPECT_THAT(message("intervals = 5", "intervals = 5\nintervals = 10"), HasSubstr("intervals"));
}

TEST_F(TaskFile, RefusesZeroIntervals) {
  EXPECT_EQ(message("intervals = 5", "intervals = 0"),
            "task.toml:7:13: phase[0].intervals: 0 is not allowed; need an integer from 1 to 10000");
}

TEST_F(TaskFile, RefusesNoPhase) {
  EXPECT_EQ(message_of("robot = \"hyq.toml\"\n"),
            "task.toml:1:1: phase: missing; need [[phase]], one or more, or [gait]: periods with one set of contacts, "
            "in order");
  EXPECT_EQ(message_of("robot = \"hyq.toml\"\nphase = []\n"),
            "task.toml:2:9: phase: an empty list is not allowed; need one phase or more");
}

TEST_F(TaskFile, RefusesSyntaxErrors) {
  EXPECT_THAT(message("intervals = 5", "intervals = "), StartsWith("task.toml:7:13: "));
  EXPECT_THAT(message("2.0\nintervals", "2,0\nintervals"), StartsWith("task.toml:6:15: "));
}

TEST_F(TaskFile, RefusesAStartThatHangsInTheAir) {
  EXPECT_THAT(
      message("[start]", "[start]\nbase_position_m = [0, 0, 1]"),
      testing::MatchesRegex("task.toml:11:1: start: contact 'lf_foot' of the first phase is [0-9.]+ mm above surface "
                            "'floor'; need at most 1 mm"));
  const std::string no_start = kTaskFile.substr(0, kTaskFile.find("[start]"));
  const std::string high = "[[surface]]\nname = \"step\"\npoint_m = [0, 0, -0.1]\n";
  EXPECT_THAT(message_of(no_start + high),
              StartsWith("task.toml:5:12: phase[0].contacts: contact 'lf_foot' of the first phase is 100.0 mm above"));
}

TEST_F(TaskFile, RefusesMissingAndSpecialFiles) {
  EXPECT_EQ(test::message_of(folder_.path(), [&] { read_task_file(folder_.path() / "crouch.toml", {}); }),
            "crouch.toml: no such file");
  EXPECT_THROW(read_task_file(folder_.path(), {}), InputError);
  EXPECT_THROW(read_task_file("/dev/zero", {}), InputError) << "would never end";
}

}  // namespace
}  // namespace prowl
