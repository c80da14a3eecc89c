#pragma once

#include <optional>
#include <vector>

#include "prowl/files/text_file.hpp"
#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/disturbances.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/simulation/simulation_options.hpp"
#include "prowl/task_file/own_terms.hpp"
#include "prowl/tracking/tracking_options.hpp"

namespace prowl {

/// Values of the command line that replace those of a task file.
struct TaskOverrides {
  std::optional<int> intervals;  ///< total, distributed over the phases as in the file; at least one each
  std::optional<int> max_iterations;
  std::optional<double> max_seconds;
  std::optional<double> tolerance;
  bool robust = false;  ///< true: as with a table [robust], if the file has none
};

/// A parsed task file with its sources, sufficient to parse it again (see
/// plan_folder/plan_folder.hpp).
struct Task {
  MotionProblem problem;
  Mesh mesh;
  bool has_intervals = true;  ///< false: `mesh` is first_mesh(), which planning refines
  SolverOptions solver;
  TrackingOptions tracking;
  std::optional<Disturbances> robust = {};        ///< what the plan is made robust against; nullopt: nothing
  SuccessCriteria success = {};                   ///< of simulations
  std::optional<double> simulated_friction = {};  ///< of all surfaces in simulations; nullopt: as planned
  SourceText task_file;
  SourceText robot_file;
  std::optional<SourceText> reference_file = {};  ///< of [reference]; nullopt without one
  TaskOverrides overrides;
  OwnTerms own_terms = {};          ///< with which the file was read
  std::vector<int> file_intervals;  ///< of each phase, before the overrides
};

}  // namespace prowl
