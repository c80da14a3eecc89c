// Every task of the repository, planned from its file alone by the command: the motions that Prowl promises.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "../io/test_files.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/io/plan_directory.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {
namespace {

const std::filesystem::path kTasks = std::filesystem::path(PROWL_SOURCE_DIR) / "tasks";

/// robot/motion of every task, in order. Those of tasks/paper have the paper's meshes, which are too coarse for the
/// certificate: tests/scripts/paper_test.py has them.
std::vector<std::string> shipped_tasks() {
  std::vector<std::string> tasks;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kTasks)) {
    if (entry.path().extension() != ".toml" || entry.path().parent_path().filename() == "paper") continue;
    tasks.push_back(std::filesystem::relative(entry.path(), kTasks).replace_extension().string());
  }
  std::ranges::sort(tasks);
  return tasks;
}

struct Planned {
  int status = -1;
  nlohmann::json plan;

  const nlohmann::json& check(const std::string& name) const {
    const auto& checks = plan.at("certificate").at("checks");
    const auto found = std::ranges::find_if(checks, [&](const auto& check) { return check.at("name") == name; });
    if (found == checks.end()) throw std::logic_error("the certificate has no check '" + name + "'");
    return *found;
  }
};

/// Where contact `name` is at a node, world frame [m].
Eigen::Vector3d contact_position(const PlanRecord& record, const TrajectoryPoint& node, const std::string& name) {
  const RobotModel& robot = record.task.problem.robot;
  const auto contact = std::ranges::find(robot.contacts(), name, &ContactPoint::name);
  if (contact == robot.contacts().end()) throw std::logic_error("no contact " + name);
  RigidBodyTerms terms(robot);
  terms.update_kinematics(node.q);
  return terms.contact_position(static_cast<int>(contact - robot.contacts().begin()));
}

std::vector<TrajectoryPoint> nodes_of_phase(const PlanRecord& record, const std::string& name) {
  const auto& phases = record.task.problem.phases;
  const auto phase = std::ranges::find(phases, name, &Phase::name);
  if (phase == phases.end()) throw std::logic_error("no phase " + name);
  std::vector<TrajectoryPoint> nodes;
  for (const TrajectoryPoint& node : record.plan.trajectory.nodes) {
    if (node.phase == phase - phases.begin()) nodes.push_back(node);
  }
  return nodes;
}

double duration(const std::vector<TrajectoryPoint>& nodes) { return nodes.back().time - nodes.front().time; }

/// How far the base, or a contact, gets from start to end.
Eigen::Vector3d way_of_base(const PlanRecord& record) {
  const auto& nodes = record.plan.trajectory.nodes;
  return base_position(nodes.back().q) - base_position(nodes.front().q);
}
Eigen::Vector3d way_of(const PlanRecord& record, const std::string& contact) {
  const auto& nodes = record.plan.trajectory.nodes;
  return contact_position(record, nodes.back(), contact) - contact_position(record, nodes.front(), contact);
}

Planned plan(const std::string& task, const std::string& options, const test::TempFolder& folder) {
  const std::filesystem::path out = folder.path() / "out";
  const std::string command = std::string("'" PROWL_COMMAND "' plan '") + (kTasks / (task + ".toml")).string() + "' " +
                              options + " --package-dir '" PROWL_ROBOTS_DATA "' --out '" + out.string() +
                              "' >/dev/null 2>&1";
  Planned planned;
  planned.status = WEXITSTATUS(std::system(command.c_str()));
  planned.plan = nlohmann::json::parse(test::read_file(out / "plan.json"));
  return planned;
}

/// The lowest that the base gets, against where it starts [m].
double lowest_base(const PlanRecord& record) {
  const auto& nodes = record.plan.trajectory.nodes;
  double lowest = 0.0;
  for (const auto& node : nodes) lowest = std::min(lowest, node.q(2) - nodes.front().q(2));
  return lowest;
}

/// What a task is for, read off the plan, where its goals do not say it all.
const std::map<std::string, std::function<void(const PlanRecord&)>> kPurposes{
    {"hyq/crouch", [](const PlanRecord& record) { EXPECT_LT(lowest_base(record), -0.17 + 1e-3); }},
    {"hyq/balance",
     [](const PlanRecord& record) {
       double in_the_air = 0.0;
       for (const Phase& phase : record.task.problem.phases) {
         if (phase.contacts.size() == 2) in_the_air += duration(nodes_of_phase(record, phase.name));
       }
       EXPECT_GE(in_the_air, 0.5 - 1e-6);
     }},
    {"hyq/rear",
     [](const PlanRecord& record) {
       double pitch = 0.0;  // of the base, nose up
       for (const auto& node : nodes_of_phase(record, "rear")) {
         pitch = std::max(pitch, std::asin(base_rotation(node.q)(2, 0)));
       }
       EXPECT_GE(pitch, 15.0 * std::numbers::pi / 180.0);
     }},
    {"hyq/step", [](const PlanRecord& record) { EXPECT_NEAR(way_of(record, "lf_foot").x(), 0.2, 1e-3); }},
    {"hyq/walk", [](const PlanRecord& record) { EXPECT_NEAR(way_of_base(record).x(), 1.0, 1e-3); }},
    {"hyq/trot", [](const PlanRecord& record) { EXPECT_NEAR(way_of_base(record).x(), 1.0, 1e-3); }},
    {"hyq/jump",
     [](const PlanRecord& record) {
       const auto flight = nodes_of_phase(record, "flight");
       EXPECT_GE(duration(flight), 0.2 - 1e-6);
       for (const char* foot : {"lf_foot", "lh_foot", "rf_foot", "rh_foot"}) {
         const double ground = contact_position(record, record.plan.trajectory.nodes.front(), foot).z();
         EXPECT_GE(contact_position(record, flight[flight.size() / 2], foot).z() - ground, 0.15 - 1e-3) << foot;
       }
     }},
    {"hyq/slope",
     [](const PlanRecord& record) {
       const Eigen::Vector3d way = way_of_base(record);
       EXPECT_NEAR(std::atan2(way.z(), way.x()), 15.0 * std::numbers::pi / 180.0, 1e-2);
     }},
    {"hyq/wall",
     [](const PlanRecord& record) {
       for (const auto& node : nodes_of_phase(record, "lean")) {
         EXPECT_LT(node.force(0), -50.0) << "of the wall on lf_foot [N], the first contact, at " << node.time;
       }
       EXPECT_NEAR(way_of_base(record).x(), 0.08, 1e-3);
     }},
    {"hyq/kneel", [](const PlanRecord& record) { EXPECT_GE(way_of_base(record).x(), 0.05); }},
    {"talos/squat", [](const PlanRecord& record) { EXPECT_LT(lowest_base(record), -0.05); }},
};

class ShippedTask : public testing::TestWithParam<std::string> {
 protected:
  test::TempFolder folder_;
};

TEST_P(ShippedTask, ConvergesAndIsWhatTheCertificateSays) {
  const Planned planned = plan(GetParam(), "", folder_);
  EXPECT_EQ(planned.plan.at("status"), "converged");
  EXPECT_EQ(planned.status, 0);
  EXPECT_EQ(planned.plan.at("certificate").at("passed"), true);
  EXPECT_LT(planned.check("contact drift").at("worst"), 1e-3);
  const nlohmann::json& tracking = planned.plan.at("tracking");
  ASSERT_FALSE(tracking.is_null()) << "no gains";
  EXPECT_TRUE(tracking.at("stands_on"));
  EXPECT_LT(tracking.at("whole").at("worst"), 0.5) << "what is left of a deviation at the start";
  const auto purpose = kPurposes.find(GetParam());
  if (purpose != kPurposes.end()) purpose->second(read_plan(folder_.path() / "out", test::test_search()));
}

INSTANTIATE_TEST_SUITE_P(All, ShippedTask, testing::ValuesIn(shipped_tasks()), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace(name, '/', '_');
  return name;
});

TEST(ShippedTasks, AreThoseOfFiveRobots) {
  const std::vector<std::string> tasks = shipped_tasks();
  for (const char* task :
       {"hyq/hold",    "hyq/stand",          "hyq/crouch",     "hyq/balance",     "hyq/step",      "hyq/rear",
        "hyq/slope",   "hyq/wall",           "hyq/kneel",      "hyq/walk",        "hyq/trot",      "hyq/jump",
        "go2/trot",    "solo12/trot",        "anymal_c/stand", "anymal_c/crouch", "anymal_c/step", "anymal_c/trot",
        "go2/stand",   "go2/crouch",         "go2/step",       "solo12/stand",    "solo12/crouch", "solo12/step",
        "talos/squat", "talos/weight_shift", "talos/step"}) {
    EXPECT_THAT(tasks, testing::Contains(task));
  }
}

/// The six nodes of the paper: said to be too few.
TEST(ShippedTasks, hyqStandFailsWithSixNodes) {
  const test::TempFolder folder;
  const Planned planned = plan("hyq/stand", "--intervals 5", folder);
  EXPECT_EQ(planned.plan.at("status"), "converged");
  EXPECT_EQ(planned.status, 7);
  EXPECT_EQ(planned.plan.at("certificate").at("grade"), "failed");
  EXPECT_EQ(planned.check("local integration error").at("passed"), false);
}

/// The order of the transcribed motion: half the step, an eighth of the integration error of an interval.
TEST(ShippedTasks, hyqCrouchIsOfThirdOrder) {
  const test::TempFolder folder;
  const auto error = [&](const char* intervals) {
    const Planned planned = plan("hyq/crouch", std::string("--max-iterations 100 --intervals ") + intervals, folder);
    return planned.check("local integration error").at("worst").get<double>();
  };
  EXPECT_GT(error("40") / error("80"), 6.5);
}

}  // namespace
}  // namespace prowl
