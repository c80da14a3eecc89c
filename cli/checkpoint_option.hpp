#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "prowl/io/checkpoint.hpp"

namespace prowl::cli {

struct CheckpointArguments {
  std::string folder;   ///< "": none
  double every = 10.0;  ///< [s]; so much work may be lost, against the time that it takes to write and sync a plan
  std::string resume;   ///< folder; "": from the task alone
};

/// --checkpoint, --checkpoint-every and --resume.
void add_checkpoint(CLI::App& verb, CheckpointArguments& arguments);

/// Sets PlanOptions::start_from to go on from the folder of --resume, if there is one, and task.mesh to its mesh if
/// that is refined. Gives what was there. Throws InputError that names the folder if it is of another task or mesh.
std::optional<PlanRecord> resume(const CheckpointArguments& arguments, const PackageSearch& search, bool is_refined,
                                 Task& task, PlanOptions& options);

/// Has checkpoints written in the solve with these options, as long as the result lives; null without --checkpoint.
/// `so_far`: task, versions and warm_start, and what is in their folder already if that is the one that is resumed: it
/// stays until there is better. Throws InputError if they were to be written into the plan's own folder `out`, one in
/// it or one that holds it, or in place of a plan that passed, FileError if they cannot be written.
std::unique_ptr<Checkpoint> write_checkpoints(const CheckpointArguments& arguments, const std::filesystem::path& out,
                                              PlanRecord so_far, PlanOptions& options);

}  // namespace prowl::cli
