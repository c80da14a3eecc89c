// Each criterion by itself: a run that keeps all, and one that breaks exactly this one.
#include "prowl/simulation/judge.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/simulation/collision_shapes.hpp"
#include "tests/simulation/standing_tracker.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// HyQ steps once, in a run without any error.
SimulationResult faultless() {
  SimulationResult result;
  result.base_position.rest = result.base_angle.rest = 0.0;
  result.slip.assign(4, 0.0);
  result.switches = {{0, false, 1.0, 1.0, 0.6}, {0, true, 1.6, 1.6, 0.6}};
  result.goals = {{"goal 1", 0.0, 0.0, 0.0, ""}};
  result.flights = {{"flight", 0.0}};
  return result;
}

struct Sabotage {
  std::string name;
  std::function<void(SimulationResult&, double size)> apply;
  double allowed;  ///< largest size that passes, for HyQ
  std::string words;
};

class Judge : public testing::TestWithParam<Sabotage> {};

INSTANTIATE_TEST_SUITE_P(
    Of, Judge,
    testing::Values(
        Sabotage{"RestPosition", [](auto& r, double x) { r.base_position.rest = x; }, 0.02, "from where the plan ends"},
        Sabotage{"RestAngle", [](auto& r, double x) { r.base_angle.rest = x; }, 0.035, "base turned"},
        Sabotage{"LiftOff", [](auto& r, double x) { r.switches[0].measured += x; }, 0.1, "late"},
        Sabotage{"Landing", [](auto& r, double x) { r.switches[1].measured -= x; }, 0.1, "early"},
        Sabotage{"ShortSwing",
                 [](auto& r, double x) {
                   r.switches[1].swing = 0.2;
                   r.switches[1].measured += x;
                 },
                 0.05, "late"},
        Sabotage{"Foothold", [](auto& r, double x) { r.switches[1].off = x; }, 0.029, "from its foothold"},
        Sabotage{"GoalPosition", [](auto& r, double x) { r.goals[0].position = x; }, 0.02, "goal 1: base"},
        Sabotage{"GoalAngle", [](auto& r, double x) { r.goals[0].angle = x; }, 0.035, "goal 1: base turned"},
        Sabotage{"GoalJoint", [](auto& r, double x) { r.goals[0].joint = x; }, 0.035, "degrees off"},
        Sabotage{"FlightHeight", [](auto& r, double x) { r.flights[0].missing = x; }, 0.029, "too low"},
        Sabotage{"Slip", [](auto& r, double x) { r.slip[2] = x; }, 0.029, "slipped"},
        Sabotage{"TorqueAtLimit", [](auto& r, double x) { r.saturated = x; }, 0.05, "at its limit"}),
    [](const auto& info) { return info.param.name; });

TEST_P(Judge, FailsByThisAlone) {
  const MotionProblem problem = test::standing_problem();
  ASSERT_NEAR(problem.robot.nominal_configuration().z(), 0.58, 0.03) << "HyQ";
  const Sabotage& sabotage = GetParam();
  SimulationResult result = faultless();
  EXPECT_THAT(failures(result, problem, {}), IsEmpty());
  sabotage.apply(result, 0.95 * sabotage.allowed);
  EXPECT_THAT(failures(result, problem, {}), IsEmpty());
  result = faultless();
  sabotage.apply(result, 1.1 * sabotage.allowed);
  EXPECT_THAT(failures(result, problem, {}), ElementsAre(HasSubstr(sabotage.words)));
}

TEST(JudgeOfEvents, NamesWhatIsNotASize) {
  const MotionProblem problem = test::standing_problem();
  SimulationResult result = faultless();
  result.switches[1].measured = std::nan("");
  EXPECT_THAT(failures(result, problem, {}), ElementsAre(HasSubstr("landing, planned at 1.600 s: did not happen")));
  result = faultless();
  result.switches[1].on_its_surface = false;
  EXPECT_THAT(failures(result, problem, {}), ElementsAre(HasSubstr("on another surface")));
  result = faultless();
  result.touches = {"trunk and floor at 1.200 s"};
  EXPECT_THAT(failures(result, problem, {}), ElementsAre("touched: trunk and floor at 1.200 s"));
  result.end = SimulationResult::End::fell;
  EXPECT_THAT(failures(result, problem, {}), ElementsAre(HasSubstr("fell at"))) << "the rest follows from it";
}

/// The same in MuJoCo: HyQ stands, and something is wrong with the plan or the world.
class Sabotaged : public testing::Test {
 protected:
  std::vector<std::string> failures_of(const MotionProblem& problem, const Tracker& tracker) const {
    SimulationOptions options;
    options.physics.collisions = collisions_;
    options.perfect_state = true;
    return simulate(problem, tracker, {}, options).failures;
  }
  MotionProblem problem_ = test::standing_problem();
  std::shared_ptr<const CollisionShapes> collisions_ = collision_shapes(problem_.robot, test::test_search());
};

TEST_F(Sabotaged, NotAtAllItSucceeds) {
  EXPECT_THAT(failures_of(problem_, test::standing_tracker(problem_)), IsEmpty());
}

/// A plan that lifts a foot, by its schedule alone.
TEST_F(Sabotaged, AFootThatStaysOnTheGroundIsSeen) {
  problem_.phases.assign(3, problem_.phases.front());
  problem_.phases[1].contacts.erase(problem_.phases[1].contacts.begin());
  TrackingPlan plan = test::standing_tracker(problem_).plan();
  plan.segments = {{"four", 0.0, 0.5, 0, 2, {true, true, true, true}},
                   {"three", 0.5, 1.0, 2, 2, {false, true, true, true}},
                   {"four again", 1.0, 1.5, 4, 2, {true, true, true, true}}};
  for (Eigen::MatrixXd* part : {&plan.q, &plan.v, &plan.tau, &plan.gains}) *part = part->replicate(1, 3).eval();
  EXPECT_THAT(failures_of(problem_, Tracker(plan)),
              ElementsAre(HasSubstr("lift-off, planned at 0.500 s: 250 ms late; 100 ms allowed"),
                          HasSubstr("landing, planned at 1.000 s: 250 ms early; 100 ms allowed")));
}

/// By the plan it is in the air all along.
TEST_F(Sabotaged, AFootThatNoPhaseHoldsIsSeen) {
  TrackingPlan plan = test::standing_tracker(problem_).plan();
  plan.segments.front().in_contact[0] = false;
  EXPECT_THROW(failures_of(problem_, Tracker(plan)), InputError) << "the plan holds it";
  problem_.phases.front().contacts.erase(problem_.phases.front().contacts.begin());
  EXPECT_THAT(failures_of(problem_, Tracker(plan)), ElementsAre(HasSubstr("touched: lf_foot, held in the air at 0")));
}

TEST_F(Sabotaged, AGoalThatIsMissedIsSeen) {
  const Tracker tracker = test::standing_tracker(problem_);
  MotionProblem other = test::with_base_goal(problem_, {0.03, 0.0, 0.0});
  EXPECT_THAT(failures_of(other, tracker), ElementsAre(HasSubstr("base 3.")));
  other = test::with_base_goal(problem_, {0.015, 0.0, 0.0});
  EXPECT_THAT(failures_of(other, tracker), IsEmpty());
}

/// A stone that reaches the belly, just so.
TEST_F(Sabotaged, WhatTouchesTheTrunkIsSeen) {
  const Eigen::VectorXd& q = problem_.start_configuration();
  Surface stone{.name = "stone", .point = {q.x(), q.y(), 0.3}};
  stone.patch = {{-0.05, -0.05}, {0.05, -0.05}, {0.05, 0.05}, {-0.05, 0.05}};
  problem_.surfaces.push_back(stone);
  const Tracker tracker = test::standing_tracker(problem_);
  EXPECT_THAT(failures_of(problem_, tracker), IsEmpty());
  double& height = problem_.surfaces.back().point.z();
  PhysicsOptions options;
  options.collisions = collisions_;
  const auto touches = [&] {
    Physics physics(problem_.robot, problem_.surfaces, options);
    physics.set_state(q, Eigen::VectorXd::Zero(problem_.robot.nv()));
    physics.step(Eigen::VectorXd::Zero(problem_.robot.nu()));
    return !physics.other_touch().empty();
  };
  while (height < 0.7 && !touches()) height += 5e-4;
  EXPECT_THAT(failures_of(problem_, tracker),
              ElementsAre(testing::AllOf(HasSubstr("touched: "), HasSubstr("trunk"), HasSubstr("stone"))))
      << height;
}

/// A trunk on the ground and legs across each other are found; the nominal posture of no robot touches anything.
TEST(CollisionShapes, AreThoseOfTheWholeRobot) {
  for (const RobotModel& robot : {test::hyq(), test::go2(), test::solo12(), test::anymal_c(), test::talos()}) {
    PhysicsOptions options;
    options.collisions = collision_shapes(robot, test::test_search());
    EXPECT_GT(options.collisions->shapes.size(), 8u) << robot.name();
    Physics physics(robot, {Surface{}}, options);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(robot.nu()), still = Eigen::VectorXd::Zero(robot.nv());
    physics.set_state(robot.nominal_configuration(), still);
    physics.step(none);
    EXPECT_EQ(physics.other_touch(), "") << robot.name();
    Eigen::VectorXd lying = robot.nominal_configuration();
    lying.z() = 0.02;
    physics.set_state(lying, still);
    physics.step(none);
    EXPECT_NE(physics.other_touch(), "") << robot.name();
  }
}

}  // namespace
}  // namespace prowl
