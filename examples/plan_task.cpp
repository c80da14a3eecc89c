// Plans a task file and says what came of it:  plan_task TASK.toml [FOLDER of robot packages]
#include <iostream>
#include <prowl/refine.hpp>
#include <prowl/solvers/riccati/riccati_solver.hpp>
#include <prowl/task_file/task_file.hpp>

int main(int count, char** arguments) try {
  prowl::PackageSearch packages;
  if (count > 2) packages.folders = {arguments[2]};

  const prowl::Task task = prowl::read_task_file(arguments[1], packages);
  const prowl::DiscreteProblem problem(task.problem, task.mesh);
  const prowl::RefineOptions until_draft{.tolerance = prowl::mesh_tolerance(prowl::CertificateGrade::draft),
                                         .mesh_is_open = !task.has_intervals};
  const prowl::Plan plan =
      prowl::make_refined_plan(problem, prowl::RiccatiSolver(), {.solver = task.solver}, until_draft).plan;
  if (plan.result.status != prowl::SolveStatus::converged || !plan.certificate.passed) {
    std::cerr << "no good plan: " << prowl::to_string(plan.result.status) << '\n';
    return 1;
  }
  for (const prowl::TrajectoryPoint& node : plan.trajectory.nodes) {
    std::cout << node.time << ' ' << node.q(2) << ' ' << node.tau.cwiseAbs().maxCoeff() << '\n';  // s, m, N m
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
