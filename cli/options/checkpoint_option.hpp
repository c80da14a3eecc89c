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
  double every = 10.0;  ///< [s]; the most work lost, against the time to write and sync a plan
  std::string resume;   ///< folder; "" without
};

/// --checkpoint, --checkpoint-every and --resume.
void add_checkpoint(CLI::App& verb, CheckpointArguments& arguments);

/// Reads the plan to resume. With --refine its mesh replaces task.mesh. Throws InputError with the
/// folder if the plan has another task or mesh.
PlanRecord read_resumable(const std::string& folder, const PackageSearch& search, const OwnTerms& own_terms,
                          const PlanRequest& request, Task& task);

/// Writes checkpoints during the solve, as long as the result lives; null without --checkpoint. A
/// resumed checkpoint in that folder is kept until a better one exists. Throws InputError if their
/// folder is `out`, inside it or around it, or contains a plan that passed; FileError if they
/// cannot be written.
std::unique_ptr<Checkpoint> write_checkpoints(const CheckpointArguments& arguments, const std::filesystem::path& out,
                                              const Task& task, PlanRequest& request);

}  // namespace prowl::cli
