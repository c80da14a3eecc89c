#pragma once

#include <stdexcept>
#include <string>

#include "prowl/plan.hpp"
#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/test_files.hpp"

namespace prowl::test {

struct SolvedTask {
  Task task;
  Trajectory trajectory;
};

/// A shipped task ("hyq/stand"), planned.
inline SolvedTask solve_task(const std::string& name) {
  Task task = read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/" + name + ".toml", test_search());
  Plan plan = make_plan({task.problem, task.mesh}, RiccatiSolver(), {.solver = task.solver});
  if (!is_good(plan)) throw std::runtime_error(name + " has no good plan");
  return {std::move(task), std::move(plan.trajectory)};
}

}  // namespace prowl::test
