// Strides that repeat: one is found, as a cycle, and repeated.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "prowl/model/configuration.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "tests/support/simulated_task.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

using test::planned;
using testing::HasSubstr;

constexpr double kNoJump = 1e-6;  ///< [m, rad, m/s, rad/s]

std::string robot_file(const std::string& robot) {
  return std::string(PROWL_SOURCE_DIR) + "/robots/" + robot + ".toml";
}

/// A gait with these lines, of a weight that suits the robot.
Task gait(const std::string& robot, const std::string& lines) {
  const double mass = RobotModel(read_robot_file(robot_file(robot), test::test_search())).mass();
  const test::TempFolder folder;
  return read_task_file(
      folder.write("task.toml",
                   fmt::format("name = \"cycle\"\nrobot = \"{}\"\n[gait]\nperiodic = true\n{}\n[cost]\n"
                               "base_position = [0, 0, 0.1]\nbase_orientation = 0.1\njoint_position = 0.1\n"
                               "base_linear_velocity = [0, 0.1, 0.1]\nbase_angular_velocity = 0.1\n"
                               "joint_velocity = 0.1\nbase_linear_acceleration = 1.0\n"
                               "base_angular_acceleration = 1.0\njoint_acceleration = 0.01\ntorque = {}\n",
                               robot_file(robot), lines, 0.75 / (mass * mass))),
      test::test_search());
}

/// Largest difference of a state and the one at the same moment of the stride before, moved.
double largest_jump(const Task& task, const Plan& plan) {
  const Cycle& cycle = *task.problem.cycle;
  const auto& nodes = plan.trajectory.nodes;
  const std::size_t of_cycle = nodes.size() / static_cast<std::size_t>(cycle.count);
  double largest = 0.0;
  for (std::size_t k = of_cycle - 1; k < nodes.size(); k += of_cycle) {
    const TrajectoryPoint &start = nodes[k + 1 - of_cycle], &end = nodes[k];
    largest = std::max({largest, difference(cycle.moved_configuration(start.q), end.q).cwiseAbs().maxCoeff(),
                        (start.v - end.v).cwiseAbs().maxCoeff()});
    if (k + 1 == nodes.size()) continue;
    const TrajectoryPoint& next = nodes[k + 1];
    largest = std::max({largest, difference(end.q, next.q).cwiseAbs().maxCoeff(),
                        (end.v - next.v).cwiseAbs().maxCoeff(), std::abs(end.time - next.time)});
  }
  return largest;
}

class Trot : public testing::TestWithParam<const char*> {};

TEST_P(Trot, RepeatsTenTimesWithoutAJump) {
  const double height =
      RobotModel(read_robot_file(robot_file(GetParam()), test::test_search())).nominal_configuration()(2);
  const double speed = 0.15 * std::sqrt(9.81 * height);
  const Task task =
      gait(GetParam(), fmt::format("kind = \"trot\"\nstrides = 10\nspeed_mps = {}\nduty_factor = 0.6", speed));
  const Plan plan = planned(task);
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  EXPECT_LT(largest_jump(task, plan), kNoJump);
  EXPECT_NE(plan.certificate.find("state after a cycle"), nullptr);
  const TrajectoryPoint &first = plan.trajectory.nodes.front(), &last = plan.trajectory.nodes.back();
  EXPECT_NEAR((last.q(0) - first.q(0)) / last.time, speed, 1e-6);
  EXPECT_GT(first.v(0), 0.5 * speed) << "it begins in motion";
}

INSTANTIATE_TEST_SUITE_P(All, Trot, testing::Values("hyq", "anymal_c", "go2", "solo12"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Cycles, AreTheSameForIpopt) {
  const Task task = gait("hyq", "kind = \"walk\"\nstrides = 2\nspeed_mps = 0.2");
  const Plan own = planned(task), other = planned(task, *make_solver("ipopt"));
  ASSERT_TRUE(is_good(own)) << own.result.message;
  ASSERT_TRUE(is_good(other)) << other.result.message;
  EXPECT_NEAR(own.result.cost, other.result.cost, 2e-3 * other.result.cost);  // meshes differ
  EXPECT_LT(largest_jump(task, other), 1e-5);                                 // Ipopt relaxes
}

/// From its first moment to its last, in motion at both.
TEST(Cycles, AreTrackedInTheSimulator) {
  const Task task = gait("hyq", "kind = \"walk\"\nstrides = 3\nspeed_mps = 0.2");
  const Plan plan = planned(task);
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  const SimulationResult result = test::simulated(task, plan.trajectory);
  EXPECT_TRUE(result.success()) << result.failures.front();
  EXPECT_NEAR(result.end_time, plan.trajectory.duration(), 0.01);
}

TEST(Cycles, TurnAndGoSideways) {
  const Task task = gait("go2",
                         "kind = \"trot\"\nstrides = 3\nspeed_mps = 0.3\nheading_rad = 0.8\nturn_rad = 0.4\n"
                         "duty_factor = 0.6");
  const Plan plan = planned(task);
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  EXPECT_LT(largest_jump(task, plan), kNoJump);
  const Eigen::VectorXd way = difference(plan.trajectory.nodes.front().q, plan.trajectory.nodes.back().q);
  EXPECT_NEAR(way.segment<3>(3).norm(), 1.2, 1e-6);
}

TEST(Cycles, RefuseWhatHasNoPlaceInThem) {
  const auto message = [&](const std::string& lines) -> std::string {
    try {
      gait("hyq", lines);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(
      message("kind = \"bound\"\nstrides = 2\nspeed_mps = 0.5\nduty_factor = 0.4"),
      HasSubstr("gait.periodic: a duty factor of 0.4 leaves no time in which all feet stand; need one above 0.5"));
  EXPECT_THAT(message("kind = \"trot\"\nstrides = 2\nspeed_mps = 0.2\nsettle_s = 1"), HasSubstr("no effect beside"));
  EXPECT_THAT(message("kind = \"trot\"\nstrides = 2\nstride_length_m = 3"), HasSubstr("need shorter ones"));
  for (const char* start : {"base_position_m = [0, [-0.1, 0.1], 0.6]", "base_linear_velocity_mps = [0.1, 0, 0]"})
    EXPECT_THAT(message(std::string("kind = \"trot\"\nstrides = 2\nspeed_mps = 0.2\n[start]\n") + start),
                HasSubstr("ranges and velocities have no effect beside gait.periodic"))
        << start;
  const Task task = gait("hyq", "kind = \"trot\"\nstrides = 2\nspeed_mps = 0.2");
  EXPECT_THROW(planned(task, *make_solver("fatrop")), InputError);
}

}  // namespace
}  // namespace prowl
