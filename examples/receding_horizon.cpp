// Plans again and again, each time one mesh interval later, towards a goal that moves:
//     receding_horizon TASK.toml [FOLDER of robot packages]
#include <iostream>
#include <prowl/mesh/receding_horizon.hpp>
#include <prowl/plan.hpp>
#include <prowl/solvers/riccati/riccati_solver.hpp>
#include <prowl/task_file/task_file.hpp>

int main(int count, char** arguments) try {
  prowl::PackageSearch packages;
  if (count > 2) packages.folders = {arguments[2]};
  const prowl::Task task = prowl::read_task_file(arguments[1], packages);
  const prowl::RiccatiSolver solver;

  prowl::DiscreteProblem problem(task.problem, task.mesh);
  prowl::Plan plan = prowl::make_plan(problem, solver, {.solver = task.solver});
  std::cout << "first plan: " << plan.result.iterations << " iterations\n";

  for (int cycle = 1; cycle <= 20; ++cycle) {
    prowl::ShiftedHorizon next = prowl::shift_horizon(problem, plan.trajectory, plan.result.stage_multipliers);
    prowl::MotionProblem later = std::move(next.problem.problem);
    later.boundary_constraints.back().q_ref(0) += 0.001;  // the goal moves on by 1 mm along x
    problem = {std::move(later), std::move(next.problem.mesh)};
    plan = prowl::make_plan(problem, solver,
                            {.solver = task.solver,
                             .warm_start = std::move(next.warm_start),
                             .warm_start_multipliers = std::move(next.warm_start_multipliers)});
    if (plan.result.status != prowl::SolveStatus::converged) {
      std::cerr << "cycle " << cycle << ": " << prowl::to_string(plan.result.status) << '\n';
      return 1;
    }
    std::cout << "cycle " << cycle << ": " << plan.result.iterations << " iterations, " << 1e3 * plan.result.seconds
              << " ms\n";
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
