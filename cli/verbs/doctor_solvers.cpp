#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "cli/verbs/doctor_checks.hpp"
#include "prowl/error.hpp"
#include "prowl/session/plan_task.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "prowl/task_file/task_file.hpp"

namespace prowl::cli {
namespace {

constexpr double kLongest = 5.0;  // [s], for a solve of 20 ms on an idle machine, or 0.3 s in a Debug build

constexpr const char* kLink = R"(<link name="{name}"><inertial><origin xyz="0 0 {center}"/><mass value="{mass}"/>
<inertia ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="{moment}"/></inertial></link>
)";

constexpr const char* kJoint = R"(<joint name="{name}" type="{type}"><parent link="{parent}"/><child link="{child}"/>
<origin xyz="{x} {y} {z}"/><axis xyz="{axis}"/><limit lower="-2" upper="2" velocity="20" effort="50"/></joint>
)";

constexpr const char* kContact = R"([[contact]]
name = "foot{0}"
frame = "foot{0}"
)";

constexpr const char* kTask = R"(robot = "robot.toml"
[[phase]]
contacts = "all"
duration_s = 0.5
intervals = 10
[[goal]]
time_s = 0.5
base_displacement_m = [0, 0, 0]
base_rpy_rad = [0, 0, 0]
[cost]
base_linear_acceleration = 1.0
base_angular_acceleration = 1.0
joint_acceleration = 0.01
joint_position = 0.1
torque = 1e-3
)";

std::string link(const std::string& name, double mass, double center, double moment) {
  return fmt::format(fmt::runtime(kLink), fmt::arg("name", name), fmt::arg("mass", mass), fmt::arg("center", center),
                     fmt::arg("moment", moment));
}

std::string joint(const std::string& name, const char* type, const std::string& parent, const std::string& child,
                  double x, double y, double z, const char* axis) {
  return fmt::format(fmt::runtime(kJoint), fmt::arg("name", name), fmt::arg("type", type), fmt::arg("parent", parent),
                     fmt::arg("child", child), fmt::arg("x", x), fmt::arg("y", y), fmt::arg("z", z),
                     fmt::arg("axis", axis));
}

/// A box on four legs with hip and knee.
Task tiny_task() {
  std::string urdf = "<robot name=\"tiny\">\n" + link("base", 10.0, 0.0, 0.2);
  std::string robot = "name = \"tiny\"\nurdf = \"tiny.urdf\"\n", nominal = "[nominal.joints]\n";
  for (int i = 0; i < 4; ++i) {
    const std::string n = std::to_string(i);
    urdf += link("thigh" + n, 0.5, -0.1, 0.002) + link("shank" + n, 0.3, -0.1, 0.001);
    urdf += fmt::format("<link name=\"foot{}\"/>\n", n);
    urdf +=
        joint("roll" + n, "revolute", "base", "hip" + n, i < 2 ? 0.2 : -0.2, i % 2 == 0 ? 0.15 : -0.15, 0.0, "1 0 0") +
        link("hip" + n, 0.3, 0.0, 0.001) +
        joint("pitch" + n, "revolute", "hip" + n, "thigh" + n, 0.0, 0.0, 0.0, "0 1 0") +
        joint("knee" + n, "revolute", "thigh" + n, "shank" + n, 0.0, 0.0, -0.2, "0 1 0") +
        joint("ankle" + n, "fixed", "shank" + n, "foot" + n, 0.0, 0.0, -0.2, "0 1 0");
    robot += fmt::format(fmt::runtime(kContact), n);
    nominal += fmt::format("pitch{0} = 0.6\nknee{0} = -1.2\n", n);
  }
  // Not an existing folder: only the texts are used.
  const std::filesystem::path folder = "/nonexistent/prowl-doctor";
  return parse_task({folder / "task.toml", kTask}, {folder / "robot.toml", robot + nominal}, {}, {},
                    {.urdf = SourceText{folder / "tiny.urdf", urdf + "</robot>\n"}});
}

Finding check_solver(const std::string& name, const Task& task) {
  std::unique_ptr<NlpSolver> solver;
  try {
    solver = make_solver(name);
  } catch (const InputError& error) {
    return {.area = "solvers",
            .name = name,
            .state = Finding::State::missing,
            .text = error.what(),
            .remedy = "pip install \"prowl[solvers]\"; in a clone: scripts/setup"};
  }
  Finding finding{.area = "solvers", .name = solver->name(), .text = {}, .remedy = ""};
  const auto began = std::chrono::steady_clock::now();
  std::string outcome;
  try {
    const Plan plan = plan_task(task, {.solver = name, .coarse_first = false, .gains = false}).record.plan;
    if (is_good(plan)) {
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
      finding.text = fmt::format("{}: solves and passes a small task in {:.0f} ms", solver->version(), 1e3 * seconds);
      if (seconds > kLongest) {
        finding.state = Finding::State::slow;
        finding.remedy = "see build and cores above";
      }
      return finding;
    }
    outcome = plan.result.status == SolveStatus::converged ? "the certificate fails" : plan.result.message;
  } catch (const Error& error) {
    outcome = error.what();
  }
  finding.state = Finding::State::missing;
  finding.text = fmt::format("{}: does not solve a small task: {}", solver->version(), outcome);
  finding.remedy = "the loaded libraries may differ from those of the build: run scripts/setup, and build again";
  finding.status = kNotSolved;
  return finding;
}

}  // namespace

std::vector<Finding> check_solvers() {
  const Task task = tiny_task();
  std::vector<Finding> findings;
  for (const std::string& name : solver_names()) findings.push_back(check_solver(name, task));
  return findings;
}

}  // namespace prowl::cli
