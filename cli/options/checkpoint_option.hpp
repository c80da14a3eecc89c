#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "prowl/plan_folder/checkpoint.hpp"
#include "prowl/session/plan_task.hpp"

namespace prowl::cli {

struct CheckpointArguments {
  std::string folder;   ///< "": none
  double every = 10.0;  ///< [s]; so much work may be lost, against the time that it takes to write and sync a plan
  std::string resume;   ///< folder; "": from the task alone
};

/// --checkpoint, --checkpoint-every and --resume.
void add_checkpoint(CLI::App& verb, CheckpointArguments& arguments);

/// The plan in the folder of --resume. If the mesh is refined, task.mesh becomes that of the plan. Throws InputError
/// that names the folder if it is of another task or mesh.
PlanRecord read_resumable(const std::string& folder, const PackageSearch& search, const PlanRequest& request,
                          Task& task);

/// Has checkpoints written while the request is planned, as long as the result lives; null without --checkpoint. What
/// is in their folder already stays until there is better, if that is the one that is resumed. Throws InputError if
/// they were to be written into the plan's own folder `out`, one in it or one that holds it, or in place of a plan that
/// passed, FileError if they cannot be written.
std::unique_ptr<Checkpoint> write_checkpoints(const CheckpointArguments& arguments, const std::filesystem::path& out,
                                              const Task& task, PlanRequest& request);

}  // namespace prowl::cli
