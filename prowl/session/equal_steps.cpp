#include "prowl/session/equal_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/mesh/first_mesh.hpp"
#include "prowl/refine.hpp"
#include "prowl/solvers/make_solver.hpp"

namespace prowl {

Mesh equal_steps_for_draft(const Task& task) {
  constexpr double kMargin = 1.25;  // on the error, which falls with the cube of the step
  constexpr int kMostTries = 5;
  const MeshTolerance draft = mesh_tolerance(CertificateGrade::draft);
  const auto solver = make_solver(solver_names().front());
  int pieces = 2;
  for (int i = 0; i < kMostTries; ++i) {
    Mesh mesh = split(task.mesh, pieces);
    if (mesh.num_intervals() > kMostIntervals) break;
    const Plan plan = make_plan({task.problem, mesh}, *solver, {.solver = task.solver});
    if (plan.result.status != SolveStatus::converged) {
      pieces *= 2;
      continue;
    }
    const std::vector<double> parts = error_parts(plan.certificate, draft);
    const double error = *std::ranges::max_element(parts);
    if (error <= 1.0) return mesh;
    pieces = std::max(pieces + 1, static_cast<int>(std::ceil(pieces * std::cbrt(kMargin * error))));
  }
  throw InputError(fmt::format("{}: no equal steps found on which the trapezoid meets grade draft; need --intervals",
                               task.task_file.path.string()));
}

}  // namespace prowl
