// Plans the task argv[1] with robot packages from the folder argv[2]: all of Prowl that a program needs to see.
#include <iostream>
#include <prowl/plan.hpp>
#include <prowl/solvers/foreign/ipopt_solver.hpp>
#include <prowl/task_file/task_file.hpp>

int main(int, char** argv) {
  const prowl::Task task = prowl::read_task_file(argv[1], {.folders = {argv[2]}, .working_directory = {}});
  const prowl::Plan plan = prowl::make_plan({task.problem, task.mesh}, prowl::IpoptSolver(), {.solver = task.solver});
  std::cout << prowl::to_string(plan.result.status) << ", cost " << plan.result.cost << '\n';
}
