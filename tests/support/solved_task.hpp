#pragma once

#include <stdexcept>
#include <string>

#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/refine.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/test_files.hpp"

namespace prowl::test {

struct SolvedTask {
  Task task;
  Trajectory trajectory;
};

/// The plan of a task on meshes of Prowl's, until it is a draft.
inline Plan planned(const Task& task, const NlpSolver& solver = RiccatiSolver()) {
  return make_refined_plan({task.problem, task.mesh}, solver, {.solver = task.solver},
                           {.tolerance = mesh_tolerance(CertificateGrade::draft), .mesh_is_open = true})
      .plan;
}

/// A shipped task ("hyq/stand"), planned.
inline SolvedTask solve_task(const std::string& name) {
  Task task = read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/" + name + ".toml", test_search());
  Plan plan = planned(task);
  if (!is_good(plan)) throw std::runtime_error(name + " has no good plan");
  return {std::move(task), std::move(plan.trajectory)};
}

}  // namespace prowl::test
