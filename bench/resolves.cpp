// In how many iterations a task is solved again from its own plan, once the goal or the start has moved a little, or
// the horizon has, interval by interval. docs/benchmarks.md says how to run it and what it prints.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/mesh/receding_horizon.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/task_file/task_file.hpp"

namespace {

using Eigen::Vector3d;
using prowl::MotionProblem;

constexpr double kGoalMoves = 0.02;                       // [m]
constexpr double kStartTurns = std::numbers::pi / 180.0;  // [rad]
constexpr int kDisturbances = 50;
constexpr int kMostShifts = 20;

/// Not std::uniform_real_distribution: its numbers differ from one standard library to another.
Vector3d random_direction(std::mt19937& random) {
  while (true) {
    const Vector3d v = Vector3d::NullaryExpr([&] { return 2.0 * random() / 4294967295.0 - 1.0; });
    if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
  }
}

/// Every goal that says where the base is, so much further.
MotionProblem with_goal_moved(const MotionProblem& task, const Vector3d& by) {
  MotionProblem problem = task;
  for (std::size_t i = 1; i < problem.boundary_constraints.size(); ++i) {
    prowl::BoundaryConstraint& goal = problem.boundary_constraints[i];
    for (int axis = 0; axis < 3; ++axis) {
      if (goal.configuration_lower(axis) == goal.configuration_upper(axis)) goal.q_ref(axis) += by(axis);
    }
  }
  return problem;
}

/// The base turned at the start, the feet where they were.
MotionProblem with_start_turned(const MotionProblem& task, const Vector3d& by) {
  prowl::RigidBodyTerms terms(task.robot);
  Eigen::VectorXd q = task.start_configuration();
  terms.update_kinematics(q);
  std::vector<prowl::ContactTarget> feet;
  for (const prowl::PhaseContact& contact : task.phases.front().contacts) {
    feet.push_back({contact.contact, terms.contact_position(contact.contact)});
  }
  prowl::set_base_rotation(q, prowl::base_rotation(q) * prowl::so3::exp(by));
  MotionProblem problem = task;
  problem.boundary_constraints.front().q_ref = prowl::inverse_kinematics(task.robot, q, feet).q;
  return problem;
}

struct Tally {
  std::vector<int> iterations;
  int failed = 0;
  void add(const prowl::Plan& plan) {
    if (plan.result.status == prowl::SolveStatus::converged) {
      iterations.push_back(plan.result.iterations);
    } else {
      ++failed;
    }
  }
  void print(const char* what) {
    std::sort(iterations.begin(), iterations.end());
    if (iterations.empty()) iterations = {-1};
    fmt::print("  {:<22} median {}, worst {} iterations; {} not solved\n", what, iterations[iterations.size() / 2],
               iterations.back(), failed);
    std::fflush(stdout);
  }
};

Tally resolve(const prowl::Task& task, const prowl::Plan& plan, auto disturbed) {
  std::mt19937 random(1);
  Tally tally;
  for (int i = 0; i < kDisturbances; ++i) {
    prowl::PlanOptions options{
        .solver = task.solver, .warm_start = plan.trajectory, .warm_start_multipliers = plan.result.stage_multipliers};
    tally.add(prowl::make_plan({disturbed(random_direction(random)), task.mesh}, prowl::RiccatiSolver(), options));
  }
  return tally;
}

/// Each from the plan before it, as a receding horizon does.
Tally shift(const prowl::Task& task, const prowl::Plan& first) {
  Tally tally;
  prowl::DiscreteProblem discrete(task.problem, task.mesh);
  prowl::Plan plan = first;
  for (int i = 0; i < kMostShifts && discrete.mesh.phases.front().intervals() > 1; ++i) {
    prowl::ShiftedHorizon next = prowl::shift_horizon(discrete, plan.trajectory, plan.result.stage_multipliers);
    discrete = std::move(next.problem);
    plan = prowl::make_plan(discrete, prowl::RiccatiSolver(),
                            {.solver = task.solver,
                             .warm_start = std::move(next.warm_start),
                             .warm_start_multipliers = std::move(next.warm_start_multipliers)});
    tally.add(plan);
    if (plan.result.status != prowl::SolveStatus::converged) break;
  }
  return tally;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    fmt::print(stderr, "usage: resolves TASK.toml ...\n");
    return 2;
  }
  const prowl::PackageSearch search{.folders = {}, .working_directory = std::filesystem::current_path()};
  for (int i = 1; i < argc; ++i) {
    const prowl::Task task = prowl::read_task_file(argv[i], search);
    const prowl::Plan plan =
        prowl::make_plan({task.problem, task.mesh}, prowl::RiccatiSolver(), {.solver = task.solver});
    fmt::print("{} {}: {} iterations from the task alone\n", task.problem.robot.name(), task.problem.name,
               plan.result.iterations);
    resolve(task, plan, [&](const Vector3d& along) {
      return with_goal_moved(task.problem, kGoalMoves * along);
    }).print("goal moved by 2 cm");
    resolve(task, plan, [&](const Vector3d& about) {
      return with_start_turned(task.problem, kStartTurns * about);
    }).print("start turned by 1 deg");
    shift(task, plan).print("horizon shifted");
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "resolves: {}\n", error.what());
  return 2;
}
