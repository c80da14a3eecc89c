// Terms of the user's own, in shipped tasks: plans keep them, by Pinocchio's placements of the bodies.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <pinocchio/algorithm/centroidal.hpp>

#include "prowl/model/body_placements.hpp"
#include "prowl/model/pinocchio_model.hpp"
#include "prowl/model/robot_frame.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "prowl/terms/own_term.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::planned;

Task with_terms(const std::string& name, const std::string& terms) {
  std::string text = test::read_file(std::string(PROWL_SOURCE_DIR) + "/tasks/" + name + ".toml");
  text = test::replaced(text, "../..", PROWL_SOURCE_DIR) + "\n" + terms;
  const test::TempFolder folder;
  return read_task_file(folder.write("task.toml", text), test::test_search());
}

class Placements {
 public:
  explicit Placements(const RobotModel& robot) : robot_(robot), bodies_(robot) {}

  Eigen::Isometry3d frame(const std::string& name, const VectorXd& q) {
    const RobotFrame frame = robot_frame(robot_, name);
    return bodies_.at(q)[frame.body] * frame.placement;
  }

 private:
  const RobotModel& robot_;
  BodyPlacements bodies_;
};

TEST(Terms, AFootPassesAPointAndTheTrunkStaysLevel) {
  const Task task = with_terms("hyq/step", R"(
[[term]]
name = "around the post"
frame = "lf_foot"
position_m = [0.47, 0.42, [0.1, 0.2]]
phase = "swing"
fraction = 0.5

[[term]]
name = "level"
frame = "trunk"
axis = [0, 0, 1]
points_along = [0, 0, 1]
within_rad = 0.01
)");
  const Plan plan = planned(task);
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  Placements placements(task.problem.robot);
  const auto swing = std::ranges::equal_range(plan.trajectory.nodes, 1, {}, &TrajectoryPoint::phase);
  const double middle = 0.5 * (swing.front().time + swing.back().time);
  const Vector3d foot = placements.frame("lf_foot", sample(plan.trajectory, middle).q).translation();
  EXPECT_NEAR(foot.x(), 0.47, 1e-5);
  EXPECT_NEAR(foot.y(), 0.42, 1e-5);
  EXPECT_GT(foot.z(), 0.1 - 1e-5);
  double most = 0.0;
  for (const TrajectoryPoint& node : plan.trajectory.nodes) {
    const Vector3d up = placements.frame("trunk", node.q).linear().col(2);
    most = std::max(most, std::acos(std::min(1.0, up.z())));
  }
  EXPECT_LT(most, 0.01 * std::sqrt(2.0) + 1e-5);
  EXPECT_GT(most, 1e-4) << "the trunk would not tilt anyway, so the test checks nothing";
}

/// While it steps, HyQ's trunk tilts by more than half a degree; a term keeps it upright.
TEST(Terms, TheTrunkDoesNotTurnAtAll) {
  const Task still = with_terms("hyq/step", "[[term]]\nframe = \"trunk\"\norientation_rpy_rad = [0, 0, 0]\n");
  const Plan loose = planned(with_terms("hyq/step", "")), tight = planned(still);
  Placements placements(still.problem.robot);
  const auto largest_turn = [&](const Trajectory& motion) {
    double most = 0.0;
    for (double t = 0.0; t <= motion.duration(); t += 0.001) {
      const Eigen::Matrix3d R = placements.frame("trunk", sample(motion, t).q).linear();
      most = std::max(most, Eigen::AngleAxisd(R).angle());
    }
    return most;
  };
  ASSERT_TRUE(is_good(tight)) << tight.result.message;
  EXPECT_LT(largest_turn(tight.trajectory), 1e-3);
  EXPECT_GT(largest_turn(loose.trajectory), 1e-2);
  EXPECT_GE(tight.result.cost, loose.result.cost);
}

/// The trunk moves by 5 cm/s sideways in the second half: a path over time, which the certificate checks as well.
TEST(Terms, TheTrunkFollowsAPathOverTime) {
  Task task = with_terms("hyq/crouch", "");
  const double begin = 1.0, speed = 0.05;
  const auto path = own_term<4, 1>({{.name = "trunk"}, {Quantity::Kind::time, ""}}, {"y"}, "m",
                                   [=](const auto& y, auto& f) { f(0) = y(1) - speed * (y(3) - begin); });
  const double duration = task.problem.phases[0].duration.max;
  TermUse use{.name = "path", .term = path};
  use.from = {0, 0.6};
  use.to = {0, 0.9};
  use.lower = use.upper = VectorXd::Zero(1);
  task.problem.terms.push_back(use);
  const Plan plan = planned(task);
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  Placements placements(task.problem.robot);
  for (double share = 0.6; share < 0.901; share += 0.01) {
    const double t = share * duration;
    const double y = placements.frame("trunk", sample(plan.trajectory, t).q).translation().y();
    EXPECT_NEAR(y, speed * (t - begin), 1e-3);
  }
}

TEST(Terms, AngularMomentumStaysInItsBand) {
  const Task task = with_terms("hyq/step", R"(
[[term]]
name = "calm"
angular_momentum_Nms = [[-0.2, 0.2], [-0.2, 0.2], [-0.2, 0.2]]
)");
  const Plan plan = planned(task), free = planned(with_terms("hyq/step", ""));
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  const pinocchio::Model& model = task.problem.robot.pinocchio().model;
  const auto largest = [&](const Trajectory& motion) {
    pinocchio::Data data(model);
    double most = 0.0;
    for (const TrajectoryPoint& node : motion.nodes) {
      pinocchio::computeCentroidalMomentum(model, data, node.q, node.v);
      most = std::max(most, data.hg.angular().cwiseAbs().maxCoeff());
    }
    return most;
  };
  EXPECT_LT(largest(plan.trajectory), 0.2 + 1e-3);
  EXPECT_GT(largest(free.trajectory), 0.3) << "it would not turn more anyway, so the test checks nothing";
}

TEST(Terms, ACostPullsInProportionToItsWeight) {
  double last = 0.0;
  const Task free = with_terms("hyq/crouch", "");
  Placements placements(free.problem.robot);
  for (const double weight : {1e3, 10.0, 0.1}) {
    const Task task = with_terms("hyq/crouch", fmt::format("[[term]]\nframe = \"trunk\"\nposition_m = [0.03, \"free\", "
                                                           "\"free\"]\nweight = {}\ntime_s = 0.5\n",
                                                           weight));
    const Plan plan = planned(task);
    ASSERT_TRUE(is_good(plan)) << plan.result.message;
    const double off = std::abs(placements.frame("trunk", sample(plan.trajectory, 0.5).q).translation().x() - 0.03);
    EXPECT_GT(off, last) << weight;
    last = off;
  }
  EXPECT_GT(last, 0.01);
}

/// Forces jump where a contact opens: both nodes of the phase transition keep their limits.
TEST(Terms, AForceIsKeptFromTheStartOfItsPhase) {
  const Task task = with_terms("hyq/step", R"(
[[term]]
name = "light"
contact = "lh_foot"
force_N = ["free", "free", ["free", 250]]
phase = "swing"
)");
  const Plan plan = planned(task), free = planned(with_terms("hyq/step", ""));
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  const auto largest = [&](const Trajectory& motion) {
    double force = 0.0;
    for (const TrajectoryPoint& node : motion.nodes) {
      if (node.phase == 1) force = std::max(force, node.force(3 * 1 + 2));
    }
    return force;
  };
  ASSERT_EQ(task.problem.robot.contact_index("lh_foot"), 1);
  EXPECT_LT(largest(plan.trajectory), 250.0 + 1e-2);
  EXPECT_GT(largest(free.trajectory), 260.0) << "the foot would not carry more anyway, so the test checks nothing";
}

/// A foot that lands carries something at once: a span that begins there leaves the phase before alone, however it is
/// written.
TEST(Terms, ASpanBeginsWithItsPhase) {
  const std::string limit = "contact = \"lf_foot\"\nforce_N = [\"free\", \"free\", [150, \"free\"]]\n";
  const Task by_time = with_terms("hyq/rear", "[[term]]\n" + limit + "time_s = [1.4, 2.2]\n");
  const Task by_phase = with_terms("hyq/rear", "[[term]]\n" + limit + "phase = \"settle\"\n");
  Task by_hand = by_phase;
  by_hand.problem.terms[0].from = PhaseFraction::end_of(1);
  const Plan plan = planned(by_phase);
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  EXPECT_GT(plan.result.cost, planned(with_terms("hyq/rear", "")).result.cost) << "the limit changes nothing";
  EXPECT_EQ(planned(by_time).result.cost, plan.result.cost);
  EXPECT_EQ(planned(by_hand).result.cost, plan.result.cost);
}

TEST(Terms, APeakShrinksWithItsWeight) {
  const auto peak = [](const Plan& plan, const RobotModel& robot) {
    double most = 0.0;
    for (const TrajectoryPoint& node : plan.trajectory.nodes) {
      most = std::max(most, node.tau.cwiseQuotient(robot.torque_limit()).cwiseAbs().maxCoeff());
    }
    return most;
  };
  std::string text = test::read_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/step.toml");
  text = test::replaced(text, "../..", PROWL_SOURCE_DIR);
  const test::TempFolder folder;
  const Task few = read_task_file(folder.write("few.toml", test::replaced(text, "[cost]", "[cost]\npeak_torque = 100")),
                                  test::test_search());
  const Plan plan = planned(few), usual = planned(with_terms("hyq/step", ""));
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  EXPECT_LT(peak(plan, few.problem.robot), 0.9 * peak(usual, few.problem.robot));
}

TEST(Terms, AllSolversFindTheSame) {
  const Task task = with_terms("hyq/crouch", R"(
[[term]]
frame = "trunk"
position_m = ["free", 0.02, "free"]
time_s = 0.5
[[term]]
frame = "trunk"
angular_velocity_radps = [[-0.1, 0.1], [-0.1, 0.1], [-0.1, 0.1]]
[[term]]
com_velocity_mps = [0, 0, 0]
weight = 1
)");
  const Plan own = planned(task);
  ASSERT_TRUE(is_good(own)) << own.result.message;
  for (const char* name : {"ipopt", "fatrop"}) {
    const Plan other = planned(task, *make_solver(name));
    ASSERT_TRUE(is_good(other)) << name << ": " << other.result.message;
    EXPECT_NEAR(other.result.cost, own.result.cost, 2e-3 * own.result.cost) << name;  // meshes differ
  }
}

}  // namespace
}  // namespace prowl
