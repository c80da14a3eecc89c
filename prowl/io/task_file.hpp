#pragma once

#include <optional>
#include <vector>

#include "prowl/io/package_path.hpp"
#include "prowl/io/text_file.hpp"
#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/simulation/simulation_options.hpp"
#include "prowl/tracking/tracking_options.hpp"

namespace prowl {

/// What the command line puts in place of a task file's values.
struct TaskOverrides {
  std::optional<int> intervals;  ///< total, shared out over the phases as in the file; at least one each
  std::optional<int> max_iterations;
  std::optional<double> max_seconds;
  std::optional<double> tolerance;
};

/// A task file, understood, and all that it was read from: enough to read it again (see plan_directory.hpp).
struct Task {
  MotionProblem problem;
  Mesh mesh;
  SolverOptions solver;
  TrackingOptions tracking;
  SuccessCriteria success = {};                   ///< of a simulation
  std::optional<double> simulated_friction = {};  ///< of all surfaces in a simulation; else as planned with
  SourceText task_file;
  SourceText robot_file;
  TaskOverrides overrides;
  std::vector<int> file_intervals;  ///< of each phase, before the overrides
};

/// Reads a task file (docs/task-file.md) and the robot file that it names. Throws InputError
/// "file:line:column: key: ..." for whatever is wrong in either.
Task read_task_file(const std::filesystem::path& path, const PackageSearch& search,
                    const TaskOverrides& overrides = {});

/// The same from a text at hand; what it names is relative to the folder of task_file.path, where no file needs to be.
Task read_task_text(const SourceText& task_file, const PackageSearch& search, const TaskOverrides& overrides = {});

/// The same from texts at hand: those that a plan keeps. `robot_file` stands for the file that the task names, and
/// `urdf` for the one that the robot names if that is not there.
Task parse_task(const SourceText& task_file, const SourceText& robot_file, const PackageSearch& search,
                const TaskOverrides& overrides = {}, const std::optional<SourceText>& urdf = std::nullopt);

/// "hyq_crouch" for tasks/hyq/crouch.toml: folder and name tell one task from another.
std::string task_slug(const std::filesystem::path& task_file);

}  // namespace prowl
