// How many random goals of a standing robot are solved from the task alone, and in how many iterations and seconds.
// docs/benchmarks.md says how to run it and what it prints.
#include <fmt/format.h>

#include <algorithm>
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
#include "prowl/io/task_file.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/ipopt_solver.hpp"

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kReach = 0.10;                            // [m], each axis
constexpr double kTilt = 10.0 * std::numbers::pi / 180.0;  // [rad], each of roll, pitch and yaw
constexpr double kLeastShareThatPasses = 0.95;

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
  auto condition = prowl::BoundaryCondition::unbounded(problem.robot, "goal",
                                                       {last_phase, task.phases.back().intervals}, goal.q);
  condition.configuration_lower.head<6>().setZero();
  condition.configuration_upper.head<6>().setZero();
  condition.velocity_lower.head<6>().setZero();
  condition.velocity_upper.head<6>().setZero();
  problem.boundary_conditions.resize(1);
  problem.boundary_conditions.push_back(std::move(condition));
  // Costs that pull to the goal of the file must not pull away from this one.
  for (prowl::QuadraticCost* cost : {&problem.running_cost, &problem.terminal_cost}) {
    if (task.boundary_conditions.size() > 1 && cost->q_ref == task.boundary_conditions.back().q_ref) cost->q_ref = goal.q;
  }
  return problem;
}

std::string first_failure(const prowl::Certificate& certificate) {
  for (const prowl::CertificateCheck& check : certificate.checks) {
    if (!check.passed) {
      return fmt::format("{} {:.3g} > {:.3g} {} {}", check.name, check.worst, check.limit, check.unit, check.where);
    }
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

struct Tally {
  int goals = 0, solved = 0, certified = 0, draft = 0;
  std::vector<double> iterations, seconds;  ///< of the goals that were solved

  void add(const prowl::Plan& plan) {
    ++goals;
    if (plan.result.status != prowl::SolveStatus::converged) return;
    ++solved;
    iterations.push_back(plan.result.iterations);
    seconds.push_back(plan.result.seconds);
    if (!plan.certificate.passed) return;
    (plan.certificate.grade == prowl::Grade::certified ? certified : draft) += 1;
  }
  int passed() const { return certified + draft; }
};

void print(const Tally& tally, int redrawn) {
  fmt::print("\n{:<12} {} of {}\n", "solved", tally.solved, tally.goals);
  fmt::print("{:<12} {} of {} ({} certified, {} draft)\n", "passed", tally.passed(), tally.goals, tally.certified,
             tally.draft);
  fmt::print("{:<12} {} (out of reach of inverse kinematics)\n", "redrawn", redrawn);
  fmt::print("{:<12} {}\n", "iterations", summary(tally.iterations, ""));
  fmt::print("{:<12} {}\n", "time", summary(tally.seconds, " s"));
}

int positive(const char* text) {
  const int value = std::atoi(text);
  if (value <= 0) throw prowl::InputError(fmt::format("{}: need a whole number above 0", text));
  return value;
}

int run(int argc, char** argv) {
  if (argc < 2 || argc > 5) {
    fmt::print(stderr, "usage: random_goals TASK.toml [GOALS [INTERVALS [SEED]]]   (100 goals, 20 intervals, seed 1)\n");
    return 2;
  }
  const int goals = argc > 2 ? positive(argv[2]) : 100;
  const int intervals = argc > 3 ? positive(argv[3]) : 20;
  const int seed = argc > 4 ? positive(argv[4]) : 1;
  const prowl::PackageSearch search{.folders = {}, .working_directory = std::filesystem::current_path()};
  const prowl::Task task = prowl::read_task_file(argv[1], search, {.intervals = intervals});

  const prowl::IpoptSolver solver;
  GoalSource source(task.problem, static_cast<unsigned>(seed));
  Tally tally;
  fmt::print("{}: {} goals, {} intervals, seed {}, {} {}\n", task.problem.name, goals, intervals, seed, solver.name(),
             solver.version());
  for (int i = 1; i <= goals; ++i) {
    const Goal goal = source.draw();
    const prowl::Plan plan = prowl::make_plan(with_goal(task.problem, goal), solver, task.solver);
    tally.add(plan);
    fmt::print("{:3}  [{:6.3f} {:6.3f} {:6.3f}] m  [{:6.3f} {:6.3f} {:6.3f}] rad  {} {}  {} iterations  {:.2f} s  {}\n",
               i, goal.shift.x(), goal.shift.y(), goal.shift.z(), goal.rpy.x(), goal.rpy.y(), goal.rpy.z(),
               prowl::to_string(plan.result.status), prowl::to_string(plan.certificate.grade), plan.result.iterations,
               plan.result.seconds, first_failure(plan.certificate));
    std::fflush(stdout);
  }
  print(tally, source.redrawn());
  return tally.passed() >= kLeastShareThatPasses * tally.goals ? 0 : 1;
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
