#include "prowl/motion/motion_problem.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "prowl/error.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/zero_cost.hpp"

namespace prowl {
namespace {

using test::zero_cost;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// HyQ stands for a second.
MotionProblem standing() {
  const RobotModel robot = test::hyq();
  BoundaryConstraint start =
      BoundaryConstraint::unbounded(robot, "start", PhaseFraction::start_of(0), robot.nominal_configuration());
  start.configuration_lower.setZero();
  start.configuration_upper.setZero();
  start.velocity_lower.setZero();
  start.velocity_upper.setZero();
  const BoundaryConstraint goal =
      BoundaryConstraint::unbounded(robot, "goal", PhaseFraction::end_of(0), robot.nominal_configuration());
  const Phase phase{"stand", {{0, 0}, {1, 0}, {2, 0}, {3, 0}}, {1.0, 1.0}};
  return {"stand", robot, {Surface{}}, {phase}, {start, goal}, zero_cost(robot), zero_cost(robot), {}};
}

std::string message_for(const MotionProblem& problem) {
  try {
    validate(problem);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string message_after(const std::function<void(MotionProblem&)>& change) {
  static const MotionProblem kStanding = standing();
  MotionProblem problem = kStanding;
  change(problem);
  return message_for(problem);
}

TEST(MotionProblem, StandingIsAccepted) { EXPECT_EQ(message_for(standing()), "accepted"); }

/// A goal that stops the base at the end, of a motion that is not repeated, on three contacts or more.
TEST(MotionProblem, CanStandAtItsEndIfAGoalStopsItOnThreeContacts) {
  MotionProblem problem = standing();
  EXPECT_FALSE(ends_at_rest(problem)) << "no goal of velocity";
  BoundaryConstraint& goal = problem.boundary_constraints.back();
  goal.velocity_lower.head<6>().setZero();
  goal.velocity_upper.head<6>().setZero();
  EXPECT_TRUE(ends_at_rest(problem));
  EXPECT_TRUE(can_stand_at_end(problem));
  problem.phases.back().contacts.resize(2);
  EXPECT_TRUE(ends_at_rest(problem));
  EXPECT_FALSE(can_stand_at_end(problem)) << "two contacts give no moment about their line";
  problem = standing();
  problem.boundary_constraints.back().velocity_lower.head<6>().setZero();
  problem.boundary_constraints.back().velocity_upper.head<6>().setConstant(0.1);
  EXPECT_FALSE(ends_at_rest(problem)) << "it may move";
  problem.boundary_constraints.back().velocity_upper.head<6>().setZero();
  problem.boundary_constraints.back().at.fraction = 0.5;
  EXPECT_FALSE(ends_at_rest(problem)) << "only for a moment";
  problem.boundary_constraints.back().at.fraction = 1.0;
  problem.cycle = Cycle{};
  EXPECT_FALSE(ends_at_rest(problem)) << "it goes on";
}

TEST(MotionProblem, AnUnboundedConstraintBindsNothing) {
  const RobotModel robot = test::hyq();
  const auto constraint = BoundaryConstraint::unbounded(robot, "goal", {1, 0.4}, robot.nominal_configuration());
  EXPECT_EQ(constraint.name, "goal");
  EXPECT_EQ(constraint.at, (PhaseFraction{1, 0.4}));
  EXPECT_EQ(constraint.q_ref, robot.nominal_configuration());
  EXPECT_EQ(constraint.configuration_lower, Eigen::VectorXd::Constant(18, -kInfinity));
  EXPECT_EQ(constraint.configuration_upper, Eigen::VectorXd::Constant(18, kInfinity));
  EXPECT_EQ(constraint.velocity_lower, Eigen::VectorXd::Constant(18, -kInfinity));
  EXPECT_EQ(constraint.velocity_upper, Eigen::VectorXd::Constant(18, kInfinity));
  EXPECT_EQ(constraint.torque_lower, Eigen::VectorXd::Constant(12, -kInfinity));
  EXPECT_EQ(constraint.torque_upper, Eigen::VectorXd::Constant(12, kInfinity));
}

struct Mistake {
  const char* name;
  std::function<void(MotionProblem&)> make;
  const char* said;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class MotionProblemMistake : public testing::TestWithParam<Mistake> {};

TEST_P(MotionProblemMistake, IsRefusedWithFieldValueAndRange) {
  EXPECT_THAT(message_after(GetParam().make), HasSubstr(GetParam().said));
}

using P = MotionProblem;
INSTANTIATE_TEST_SUITE_P(
    SurfacesAndPhases, MotionProblemMistake,
    testing::Values(
        Mistake{"normal", [](P& p) { p.surfaces[0].normal *= 2.0; }, "surfaces[0].normal: length 2"},
        Mistake{"friction", [](P& p) { p.surfaces[0].friction = 0.0; }, "surfaces[0].friction: 0 is not allowed"},
        Mistake{"friction_nan", [](P& p) { p.surfaces[0].friction = kNan; }, "surfaces[0].friction: nan"},
        Mistake{"point", [](P& p) { p.surfaces[0].point.z() = kNan; }, "surfaces[0].point[2]: nan"},
        Mistake{"no_phase", [](P& p) { p.phases.clear(); }, "phases: an empty list"},
        Mistake{"duration", [](P& p) { p.phases[0].duration = {0.0, 1.0}; },
                "phases[0].duration: 0 to 1 is not allowed; need 0 < min <= max [s]"},
        Mistake{"duration_order", [](P& p) { p.phases[0].duration = {2.0, 1.0}; }, "phases[0].duration: 2 to 1"},
        Mistake{"duration_nan", [](P& p) { p.phases[0].duration = {kNan, kNan}; }, "phases[0].duration: nan"},
        Mistake{"contact", [](P& p) { p.phases[0].contacts[1].contact = 4; },
                "phases[0].contacts[1].contact: 4 is not allowed; need 0 to 3"},
        Mistake{"surface", [](P& p) { p.phases[0].contacts[1].surface = -1; },
                "phases[0].contacts[1].surface: -1 is not allowed; need 0 to 0"},
        Mistake{"twice", [](P& p) { p.phases[0].contacts[1].contact = 0; }, "'lf_foot' is listed twice"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    BoundaryConstraints, MotionProblemMistake,
    testing::Values(
        Mistake{"none", [](P& p) { p.boundary_constraints.clear(); }, "boundary_constraints: an empty list"},
        Mistake{"phase", [](P& p) { p.boundary_constraints[1].at.phase = 1; },
                "boundary_constraints[1].at.phase: 1 is not allowed; need 0 to 0"},
        Mistake{"fraction", [](P& p) { p.boundary_constraints[1].at.fraction = 1.2; },
                "boundary_constraints[1].at.fraction: 1.2 is not allowed; need 0 to 1"},
        Mistake{"fraction_below", [](P& p) { p.boundary_constraints[1].at.fraction = -0.2; },
                "boundary_constraints[1].at.fraction: -0.2 is not allowed; need 0 to 1"},
        Mistake{"fraction_nan", [](P& p) { p.boundary_constraints[1].at.fraction = kNan; },
                "boundary_constraints[1].at.fraction: nan is not allowed"},
        Mistake{"size", [](P& p) { p.boundary_constraints[1].velocity_lower.setZero(12); },
                "boundary_constraints[1].velocity_lower: 12 entries are not allowed; need 18"},
        Mistake{"order", [](P& p) { p.boundary_constraints[1].torque_lower(3) = kInfinity; },
                "boundary_constraints[1].torque[3]: inf to inf"},
        Mistake{"nan", [](P& p) { p.boundary_constraints[1].configuration_upper(2) = kNan; },
                "boundary_constraints[1].configuration[2]: -inf to nan"},
        Mistake{"q_ref_nan", [](P& p) { p.boundary_constraints[1].q_ref(0) = kNan; }, "q_ref[0]: nan"},
        Mistake{"quaternion", [](P& p) { p.boundary_constraints[1].q_ref.segment<4>(3) *= 1.1; },
                "boundary_constraints[1].q_ref: base quaternion of length 1.1"},
        Mistake{"goal_joint", [](P& p) { p.boundary_constraints[1].configuration_lower(8) = 2.0; },
                "boundary_constraints[1].configuration: 0.5 to inf for joint 'lf_kfe_joint' is outside its limits"},
        Mistake{"goal_velocity", [](P& p) { p.boundary_constraints[1].velocity_upper(6) = -20.0; },
                "boundary_constraints[1].velocity: -inf to -20 for joint 'lf_haa_joint'"},
        Mistake{"goal_torque", [](P& p) { p.boundary_constraints[1].torque_lower(0) = 151.0; },
                "boundary_constraints[1].torque: 151 to inf for joint 'lf_haa_joint' is outside its limits; need some "
                "part of -150 to 150"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Start, MotionProblemMistake,
    testing::Values(
        Mistake{"elsewhere", [](P& p) { p.boundary_constraints[0].at.fraction = 0.2; },
                "the first condition is the start"},
        Mistake{"beside_its_reference",
                [](P& p) {
                  p.boundary_constraints[0].configuration_lower(0) = p.boundary_constraints[0].configuration_upper(0) =
                      0.1;
                },
                "boundary_constraints[0].configuration: a fixed start is its q_ref; need bounds of 0"},
        Mistake{"joint_limit", [](P& p) { p.boundary_constraints[0].q_ref(9) = 0.0; },
                "boundary_constraints[0].configuration: 0 to 0 for joint 'lf_kfe_joint' is outside its limits"},
        Mistake{"above", [](P& p) { p.boundary_constraints[0].q_ref(2) += 0.0015; },
                "contact 'lf_foot' of the first phase is 1.5 mm above surface 'floor'; need at most 1 mm"},
        Mistake{"inside", [](P& p) { p.boundary_constraints[0].q_ref(2) -= 0.0015; }, "1.5 mm inside surface 'floor'"},
        Mistake{
            "off_the_patch", [](P& p) { p.surfaces[0].patch = {{-1.0, -1.0}, {0.3, -1.0}, {0.3, 1.0}, {-1.0, 1.0}}; },
            "contact 'lf_foot' of the first phase is 70.8 mm outside the patch of surface 'floor'; need at most 1 mm"},
        Mistake{"under_ground", [](P& p) { p.surfaces.push_back(Surface{.name = "table", .point = {0.0, 0.0, 1.0}}); },
                "contact 'lf_foot' starts 1000.0 mm inside surface 'table'"},
        Mistake{"moving",
                [](P& p) {
                  p.boundary_constraints[0].velocity_lower(2) = p.boundary_constraints[0].velocity_upper(2) = 0.5;
                },
                "contact 'lf_foot' of the first phase moves at 0.5 m/s"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Costs, MotionProblemMistake,
    testing::Values(
        Mistake{"negative", [](P& p) { p.running_cost.velocity_weight(3) = -1.0; },
                "running_cost.velocity_weight[3]: -1 is not allowed; need a weight >= 0"},
        Mistake{"clearance", [](P& p) { p.swing_clearance = -0.1; }, "swing_clearance: -0.1 is not allowed"},
        Mistake{"stand", [](P& p) { p.stands_at_end = true; },
                "stands_at_end: true is not allowed; need a goal that stops the base at the end, on three contacts or "
                "more"},
        Mistake{"load", [](P& p) { p.least_load = 1.0; }, "least_load: 1 is not allowed; need a share >= 0 and < 1"},
        Mistake{"clockwise", [](P& p) { p.surfaces[0].patch = {{0.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}}; },
                "surfaces[0].patch: the corners after corner 1 do not turn left"},
        Mistake{"two_corners", [](P& p) { p.surfaces[0].patch = {{0.0, 0.0}, {0.0, 1.0}}; },
                "surfaces[0].patch: a patch of 2 corners is not allowed; need 3 or more"},
        Mistake{"foothold", [](P& p) { p.phases[0].contacts[1].foothold = Eigen::Vector3d(0.3, 0.3, 0.02); },
                "phases[0].contacts[1].foothold: 20.0 mm above surface 'floor' is not allowed"},
        Mistake{"foothold_at_the_start",
                [](P& p) { p.phases[0].contacts[1].foothold = Eigen::Vector3d(0.3, 0.3, 0.0); },
                "phases[0].contacts[1].foothold: contact 'lh_foot' does not land in this phase: it starts at its "
                "position in "
                "the start posture"},
        Mistake{"foothold_held",
                [](P& p) {
                  p.phases.push_back(p.phases[0]);
                  p.phases[1].contacts[2].foothold = Eigen::Vector3d(0.3, 0.3, 0.0);
                },
                "phases[1].contacts[2].foothold: contact 'rf_foot' does not land in this phase: it already stands in "
                "the phase before"},
        Mistake{"slides",
                [](P& p) {
                  p.surfaces.push_back(Surface{.name = "step", .point = {0.0, 0.0, 0.1}});
                  p.phases.push_back(p.phases[0]);
                  p.phases[1].contacts[2].surface = 1;
                },
                "goes from surface 'floor' to 'step' without opening"},
        Mistake{"two_rotations",
                [](P& p) {
                  p.phases.push_back(p.phases[0]);
                  p.boundary_constraints[1].configuration_lower.segment<3>(3).setZero();
                  p.boundary_constraints.push_back(p.boundary_constraints[1]);
                  p.boundary_constraints[2].at =
                      PhaseFraction::start_of(1);  // the other side of the switch: the same time
                },
                "boundary_constraints[2].configuration: it binds the base's rotation at the same time as"},
        Mistake{"terminal", [](P& p) { p.terminal_cost.force_weight.setOnes(); },
                "terminal_cost.force_weight: has no meaning in a terminal cost"},
        Mistake{"size", [](P& p) { p.terminal_cost.torque_weight.setZero(11); },
                "terminal_cost.torque_weight: 11 entries are not allowed; need 12"},
        Mistake{"reference", [](P& p) { p.running_cost.tau_ref(0) = kInfinity; }, "running_cost.tau_ref[0]: inf"},
        Mistake{"force", [](P& p) { p.running_cost.force_weight.x() = -1.0; }, "running_cost.force_weight[0]: -1"},
        Mistake{
            "contact",
            [](P& p) { p.running_cost.contact_positions = {{7, Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}}; },
            "running_cost.contact_positions[0].contact: 7"},
        Mistake{"tolerance", [](P& p) { p.goal_tolerance.angle = 0.0; }, "goal_tolerance.angle: 0 is not allowed"}),
    [](const auto& info) { return info.param.name; });

TEST(MotionProblem, StartMayBeAMillimetreOffTheGroundAndSwingFeetAnywhere) {
  EXPECT_EQ(message_after([](P& p) { p.boundary_constraints[0].q_ref(2) += 0.0009; }), "accepted");
  EXPECT_EQ(message_after([](P& p) {
              p.phases[0].contacts.erase(p.phases[0].contacts.begin());  // lf_foot swings
              p.boundary_constraints[0].q_ref(9) -= 0.3;
            }),
            "accepted");
}

TEST(MotionProblem, AskForAShareOfAnEvenLoad) {
  MotionProblem problem = standing();
  problem.least_load = 0.2;
  const Phase& phase = problem.phases.front();
  const double share = 0.2 * problem.robot.weight() / static_cast<double>(phase.contacts.size());
  PhaseContact held = phase.contacts.front();
  EXPECT_DOUBLE_EQ(least_load(problem, phase, held), share);
  problem.surfaces[static_cast<std::size_t>(held.surface)].normal = {-0.6, 0.0, 0.8};
  EXPECT_DOUBLE_EQ(least_load(problem, phase, held), 0.8 * share);
  problem.surfaces[static_cast<std::size_t>(held.surface)].normal = {-1.0, 0.0, 0.0};
  EXPECT_EQ(least_load(problem, phase, held), 0.0) << "a wall carries no weight";
  held.unloaded = true;
  EXPECT_EQ(least_load(problem, phase, held), 0.0);
}

}  // namespace
}  // namespace prowl
