// How many random goals of a standing robot are solved from the task alone, and in how many iterations and seconds.
// docs/benchmarks.md explains how to run it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/task_file/task_file.hpp"

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kReach = 0.10;                            // [m], each axis
constexpr double kTilt = 10.0 * std::numbers::pi / 180.0;  // [rad], each of roll, pitch and yaw
constexpr double kLeastShareThatPasses = 0.95;
constexpr int kMostMeshes = 3;  // the first and two finer ones

struct Goal {
  Vector3d shift;  ///< of the base from the start, world frame [m]
  Vector3d rpy;    ///< of the base from the start [rad]
  VectorXd q;      ///< with the feet where they stand
};

/// Draws base poses about the start until the legs reach: all feet in place, all joints within their limits.
class GoalSource {
 public:
  GoalSource(const prowl::MotionProblem& problem, unsigned seed) : problem_(problem), random_(seed) {
    prowl::RigidBodyTerms terms(problem.robot);
    terms.update_kinematics(problem.start_configuration());
    for (const prowl::PhaseContact& contact : problem.phases.front().contacts) {
      feet_.push_back({contact.contact, terms.contact_position(contact.contact)});
    }
  }

  Goal draw() {
    for (;; ++redrawn_) {
      Goal goal{.shift = uniform3(kReach), .rpy = uniform3(kTilt), .q = problem_.start_configuration()};
      goal.q.head<3>() += goal.shift;
      prowl::set_base_rotation(goal.q, prowl::base_rotation(goal.q) * prowl::rotation_from_rpy(goal.rpy));
      const prowl::InverseKinematics reached = prowl::inverse_kinematics(problem_.robot, goal.q, feet_);
      if (!reached.converged) continue;
      goal.q = reached.q;
      return goal;
    }
  }
  int redrawn() const { return redrawn_; }

 private:
  /// Not std::uniform_real_distribution: its numbers differ from one standard library to another.
  Vector3d uniform3(double bound) {
    return Vector3d::NullaryExpr([&] { return bound * (2.0 * random_() / 4294967295.0 - 1.0); });
  }

  const prowl::MotionProblem& problem_;
  std::mt19937 random_;
  std::vector<prowl::ContactTarget> feet_;
  int redrawn_ = 0;
};

/// The problem of the task file with another goal: base at rest in the goal's pose at the end, joints free.
prowl::MotionProblem with_goal(const prowl::MotionProblem& task, const Goal& goal) {
  prowl::MotionProblem problem = task;
  const int last_phase = static_cast<int>(task.phases.size()) - 1;
  auto constraint =
      prowl::BoundaryConstraint::unbounded(problem.robot, "goal", prowl::PhaseFraction::end_of(last_phase), goal.q);
  constraint.configuration_lower.head<6>().setZero();
  constraint.configuration_upper.head<6>().setZero();
  constraint.velocity_lower.head<6>().setZero();
  constraint.velocity_upper.head<6>().setZero();
  problem.boundary_constraints.resize(1);
  problem.boundary_constraints.push_back(std::move(constraint));
  // Costs that pull to the goal of the file must not pull away from this one.
  for (prowl::QuadraticCost* cost : {&problem.running_cost, &problem.terminal_cost}) {
    if (task.boundary_constraints.size() > 1 && cost->q_ref == task.boundary_constraints.back().q_ref)
      cost->q_ref = goal.q;
  }
  return problem;
}

/// Where the integration error alone is too large: how many intervals bring it to four fifths of its limit, as it falls
/// with the cube of the step. 0 where a finer mesh is not the remedy.
int finer_mesh(const prowl::Plan& plan, int intervals) {
  if (plan.result.status != prowl::SolveStatus::converged) return 0;
  for (const prowl::CertificateCheck& check : plan.certificate.checks) {
    if (check.name != "local integration error" || !(check.worst > check.limit)) continue;
    return static_cast<int>(std::ceil(intervals * std::cbrt(check.worst / (0.8 * check.limit))));
  }
  return 0;
}

std::string first_failure(const prowl::Certificate& certificate) {
  for (const prowl::CertificateCheck& check : certificate.checks) {
    if (!check.passed) return fmt::format("{}: {:.3g} {} {}", check.name, check.worst, check.unit, check.where);
  }
  return {};
}

/// Median and worst of a series.
std::string summary(std::vector<double> values, const char* unit) {
  if (values.empty()) return "none";
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  const double median = values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  return fmt::format("median {:.4g}{}, worst {:.4g}{}", median, unit, values.back(), unit);
}

/// What came of one goal, over all of its meshes.
struct Outcome {
  prowl::Plan plan;  ///< the last
  int intervals = 0, iterations = 0, meshes = 0;
  double seconds = 0.0;
  bool solved() const { return plan.result.status == prowl::SolveStatus::converged; }
  bool passed() const { return solved() && plan.certificate.passed; }
};

struct Tally {
  int goals = 0, solved = 0, passed = 0, certified = 0, passed_on_first_mesh = 0;
  std::vector<double> iterations, seconds, intervals;  ///< of the goals that were solved

  void add(const Outcome& outcome) {
    ++goals;
    if (!outcome.solved()) return;
    ++solved;
    iterations.push_back(outcome.iterations);
    seconds.push_back(outcome.seconds);
    intervals.push_back(outcome.intervals);
    if (!outcome.passed()) return;
    ++passed;
    certified += outcome.plan.certificate.grade == prowl::CertificateGrade::certified;
    passed_on_first_mesh += outcome.meshes == 1;
  }
};

void print(int number, const Goal& goal, const Outcome& outcome) {
  fmt::print("{:3}  [{:6.3f} {:6.3f} {:6.3f}] m  [{:6.3f} {:6.3f} {:6.3f}] rad  ", number, goal.shift.x(),
             goal.shift.y(), goal.shift.z(), goal.rpy.x(), goal.rpy.y(), goal.rpy.z());
  fmt::print("{} {}  {} intervals, {} iterations, {:.2f} s  {}\n", prowl::to_string(outcome.plan.result.status),
             prowl::to_string(outcome.plan.certificate.grade), outcome.intervals, outcome.iterations, outcome.seconds,
             first_failure(outcome.plan.certificate));
  std::fflush(stdout);
}

void print(const Tally& tally, int redrawn) {
  fmt::print("\n{:<12} {} of {}\n", "solved", tally.solved, tally.goals);
  fmt::print("{:<12} {} of {}: {} certified, {} draft; {} on their first mesh\n", "passed", tally.passed, tally.goals,
             tally.certified, tally.passed - tally.certified, tally.passed_on_first_mesh);
  fmt::print("{:<12} {} (out of reach of inverse kinematics)\n", "redrawn", redrawn);
  fmt::print("{:<12} {}\n", "intervals", summary(tally.intervals, ""));
  fmt::print("{:<12} {}\n", "iterations", summary(tally.iterations, ""));
  fmt::print("{:<12} {}\n", "time", summary(tally.seconds, " s"));
}

int positive(const char* text) {
  const int value = std::atoi(text);
  if (value <= 0) throw prowl::InputError(fmt::format("{}: need a whole number above 0", text));
  return value;
}

/// Plans on the mesh asked for and, while only the integration error is too large, on the mesh that the error asks for.
Outcome reach(const std::string& task_file, const Goal& goal, int intervals) {
  const prowl::PackageSearch search{.folders = {}, .working_directory = std::filesystem::current_path()};
  const prowl::RiccatiSolver solver;
  Outcome outcome;
  while (intervals > 0 && outcome.meshes < kMostMeshes) {
    const prowl::Task task = prowl::read_task_file(task_file, search, {.intervals = intervals});
    outcome.plan = prowl::make_plan({with_goal(task.problem, goal), task.mesh}, solver, {.solver = task.solver});
    outcome.intervals = intervals;
    outcome.iterations += outcome.plan.result.iterations;
    outcome.seconds += outcome.plan.result.seconds;
    ++outcome.meshes;
    intervals = finer_mesh(outcome.plan, intervals);
  }
  return outcome;
}

int run(int argc, char** argv) {
  if (argc < 2 || argc > 5) {
    fmt::print(stderr,
               "usage: random_goals TASK.toml [GOALS [INTERVALS [SEED]]]   (100 goals, 40 intervals, seed 1)\n");
    return 2;
  }
  const int goals = argc > 2 ? positive(argv[2]) : 100;
  const int intervals = argc > 3 ? positive(argv[3]) : 40;
  const int seed = argc > 4 ? positive(argv[4]) : 1;
  const prowl::PackageSearch search{.folders = {}, .working_directory = std::filesystem::current_path()};
  const prowl::Task task = prowl::read_task_file(argv[1], search);

  GoalSource source(task.problem, static_cast<unsigned>(seed));
  Tally tally;
  fmt::print("{}: {} goals, {} intervals at first, seed {}\n", task.problem.name, goals, intervals, seed);
  for (int i = 1; i <= goals; ++i) {
    const Goal goal = source.draw();
    const Outcome outcome = reach(argv[1], goal, intervals);
    tally.add(outcome);
    print(i, goal, outcome);
  }
  print(tally, source.redrawn());
  return tally.passed >= kLeastShareThatPasses * tally.goals ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "random_goals: {}\n", error.what());
    return 2;
  }
}
