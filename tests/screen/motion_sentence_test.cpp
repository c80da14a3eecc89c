// What a newcomer reads of a plan: what the robot does, in a sentence, and where it has no margin.
#include "screen/motion_sentence.hpp"

#include <gmock/gmock.h>

#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;

/// The base at these displacements from the start, one node each, with the weight on the contacts of each phase.
Trajectory moving(const MotionProblem& problem, const std::vector<std::pair<int, Vector3d>>& path) {
  Trajectory trajectory;
  for (const auto& [phase, displacement] : path) {
    TrajectoryPoint point{.time = 0.5 * static_cast<double>(trajectory.nodes.size()), .phase = phase};
    point.q = problem.start_configuration();
    point.q.head<3>() += displacement;
    point.force.setZero(3 * static_cast<Eigen::Index>(problem.robot.contacts().size()));
    const std::vector<PhaseContact>& held = problem.phases[phase].contacts;
    for (const PhaseContact& contact : held)
      point.force(3 * contact.contact + 2) = problem.robot.weight() / static_cast<double>(held.size());
    trajectory.nodes.push_back(point);
  }
  return trajectory;
}

std::string said(const MotionProblem& problem, const std::vector<std::pair<int, Vector3d>>& path) {
  return motion_in_words(problem, moving(problem, path));
}

TEST(MotionSentence, TellsWhatTheBaseDoesOverFeetThatStay) {
  const MotionProblem standing = test::standing_problem();
  EXPECT_EQ(said(standing, {{0, {0, 0, 0}}, {0, {0.01, 0, -0.17}}, {0, {0, 0, 0}}}),
            "HyQ crouches 17 cm and stands up again");
  EXPECT_EQ(said(standing, {{0, {0, 0, 0}}, {0, {0, 0, -0.17}}}), "HyQ lowers its base by 17 cm");
  EXPECT_EQ(said(standing, {{0, {0, 0, 0}}, {0, {0, 0, 0.1}}}), "HyQ raises its base by 10 cm");
  EXPECT_EQ(said(standing, {{0, {0, 0, 0}}, {0, {0.06, 0, 0}}}), "HyQ moves its base by 6 cm");
  EXPECT_EQ(said(standing, {{0, {0, 0, 0}}, {0, {0.001, 0, 0}}}), "HyQ stands still");
}

TEST(MotionSentence, TellsOfTurning) {
  const MotionProblem standing = test::standing_problem();
  Trajectory trajectory = moving(standing, {{0, {0, 0, 0}}, {0, {0, 0, 0}}});
  set_base_rotation(trajectory.nodes[1].q, rotation_from_rpy({0.0, 0.0, std::numbers::pi / 6.0}));
  EXPECT_EQ(motion_in_words(standing, trajectory), "HyQ turns its base by 30 degrees");
}

/// Three phases; the second is without the contacts from `first` on.
MotionProblem lifting(int first, bool lands = true) {
  MotionProblem problem = test::standing_problem();
  Phase lifted = problem.phases[0], landed = problem.phases[0];
  lifted.name = "lifted";
  landed.name = "landed";
  lifted.contacts.erase(lifted.contacts.begin() + first, lifted.contacts.end());
  problem.phases.push_back(lifted);
  if (lands) problem.phases.push_back(landed);
  return problem;
}

TEST(MotionSentence, CountsSteps) {
  EXPECT_EQ(said(lifting(2), {{0, {0, 0, 0}}, {1, {0.1, 0, 0}}, {2, {1.25, 0, 0}}}),
            "HyQ takes 2 steps and moves 1.25 m forward");
  EXPECT_EQ(said(lifting(3), {{0, {0, 0, 0}}, {1, {0, -0.1, 0}}, {2, {0.01, -0.2, 0}}}),
            "HyQ takes 1 step and moves 20 cm to the right");
  EXPECT_EQ(said(lifting(3), {{0, {0, 0, 0}}, {1, {0, 0, 0}}, {2, {0, 0, 0}}}), "HyQ takes 1 step");
}

TEST(MotionSentence, TellsOfJumpsAndLiftedFeet) {
  EXPECT_EQ(said(lifting(0), {{0, {0, 0, 0}}, {1, {0.2, 0, 0.2}}, {2, {0.4, 0, 0}}}), "HyQ jumps 40 cm forward");
  EXPECT_EQ(said(lifting(2, false), {{0, {0, 0, 0}}, {1, {0, 0, 0.1}}}),
            "HyQ raises its base by 10 cm and lifts 2 feet");
}

// Along the heading of the robot, not along x of the world.
TEST(MotionSentence, GoesByTheHeadingOfTheStart) {
  const MotionProblem problem = lifting(3);
  Trajectory trajectory = moving(problem, {{0, {0, 0, 0}}, {1, {0, 0, 0}}, {2, {0, 0.5, 0}}});
  for (TrajectoryPoint& node : trajectory.nodes)
    set_base_rotation(node.q, rotation_from_rpy({0.0, 0.0, 0.5 * std::numbers::pi}));
  EXPECT_EQ(motion_in_words(problem, trajectory), "HyQ takes 1 step and moves 50 cm forward");
}

TEST(MotionSentence, NamesTheLargestTorque) {
  Certificate certificate;
  EXPECT_EQ(torque_in_words(certificate), "");
  certificate.checks = {{"joint torque", 0.6512, 1.001, "of limit", 0.2, "lf_kfe_joint", true}};
  EXPECT_EQ(torque_in_words(certificate), "Largest torque: 65 % of its limit at lf_kfe_joint.");
}

TEST(MissingMargin, IsToldOfFrictionWhereAFootCarriesLoad) {
  MotionProblem problem = test::standing_problem();
  Trajectory trajectory = moving(problem, {{0, {0, 0, 0}}, {0, {0, 0, 0}}});
  EXPECT_EQ(missing_margin(problem, trajectory, {}), "");
  Eigen::VectorXd& force = trajectory.nodes[1].force;
  force(3) = 0.4999 * force(5);  // x of the second contact, against its z; friction is 0.5
  EXPECT_THAT(missing_margin(problem, trajectory, {}),
              testing::MatchesRegex("next to no margin: friction at lh_foot \\(0\\.02[0-9]* N left\\)"));
  force.segment<3>(3) = Vector3d(0.5, 0.0, 1.0);  // about to lift
  EXPECT_EQ(missing_margin(problem, trajectory, {}), "");
  problem.surfaces[0].friction = 0.001;
  EXPECT_THAT(missing_margin(problem, trajectory, {}), testing::HasSubstr("friction at ")) << "on ice";
}

TEST(MissingMargin, IsToldOfJointsAtTheirLimits) {
  const MotionProblem problem = test::standing_problem();
  const Trajectory trajectory = moving(problem, {{0, {0, 0, 0}}});
  Certificate certificate;
  certificate.checks = {{"joint torque", 0.9998, 1.001, "of limit", 0.2, "lf_kfe_joint", true},
                        {"joint velocity", 0.7, 1.001, "of limit", 0.2, "rf_kfe_joint", true}};
  EXPECT_EQ(missing_margin(problem, trajectory, certificate),
            "next to no margin: torque of lf_kfe_joint (100 % of its limit)");
  certificate.checks[0].worst = 0.99;
  EXPECT_EQ(missing_margin(problem, trajectory, certificate), "");
}

}  // namespace
}  // namespace prowl
