#include "checkpoint_option.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output.hpp"
#include "prowl/error.hpp"
#include "prowl/io/atomic_folder.hpp"
#include "prowl/mesh/mesh_levels.hpp"
#include "shared_options.hpp"

namespace prowl::cli {

namespace fs = std::filesystem;

void add_checkpoint(CLI::App& verb, CheckpointArguments& arguments) {
  CLI::Option* const folder = add_folder(verb, "--checkpoint", arguments.folder,
                                         "Keep the best iterate in this folder while it solves, for --resume");
  verb.add_option(
          "--checkpoint-every", arguments.every,
          fmt::format("Seconds between two that are written; default {:g}, 0: each that is better", arguments.every))
      ->check(nonnegative_number())
      ->type_name("S")
      ->needs(folder);
  add_folder(verb, "--resume", arguments.resume,
             "Go on from this checkpoint, or from a plan that was not finished, of the same task");
}

namespace {

bool is_in(const fs::path& path, const fs::path& folder) {
  return std::ranges::mismatch(folder, path).in1 == folder.end();
}

}  // namespace

std::optional<PlanRecord> resume(const CheckpointArguments& arguments, const PackageSearch& search, bool is_refined,
                                 Task& task, PlanOptions& options) {
  if (arguments.resume.empty()) return std::nullopt;
  PlanRecord record = read_plan(arguments.resume, search);
  std::vector<Mesh> meshes;
  if (!is_refined) meshes = options.coarse_first ? mesh_levels(task.problem, task.mesh) : std::vector{task.mesh};
  try {
    check_resumable(record, task, meshes);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--resume {}: {}", arguments.resume, error.what()));
  }
  if (is_refined) task.mesh = record.plan.mesh;
  options.start_from = record.plan.trajectory;
  options.resume = true;
  return record;
}

std::unique_ptr<Checkpoint> write_checkpoints(const CheckpointArguments& arguments, const std::filesystem::path& out,
                                              PlanRecord so_far, PlanOptions& options) {
  if (arguments.folder.empty()) return nullptr;
  const fs::path folder = real_path(arguments.folder), plan_folder = real_path(out);
  if (folder == plan_folder) {
    throw InputError(fmt::format(
        "--checkpoint {}: is where the plan goes, and may hold an earlier one; need another folder", arguments.folder));
  }
  if (is_in(folder, plan_folder) || is_in(plan_folder, folder)) {
    throw InputError(
        fmt::format("--checkpoint {}: the plan goes to {}, and each takes its folder's place as a whole; need a folder "
                    "beside it",
                    arguments.folder, out.string()));
  }
  if (holds_good_plan(folder)) {
    throw InputError(fmt::format("--checkpoint {}: holds a plan that passed; need another folder", arguments.folder));
  }
  const bool is_resumed = !arguments.resume.empty() && real_path(arguments.resume) == folder;
  if (!is_resumed) so_far.plan = {};
  if (!is_resumed && fs::exists(folder / "plan.json")) {
    print_note(fmt::format("replaces what is in {}; --resume would go on from it", arguments.folder));
  }
  auto checkpoint = std::make_unique<Checkpoint>(arguments.folder, arguments.every, std::move(so_far));
  checkpoint->watch(options, [](const std::string& why) { print_note("no checkpoint, planning goes on: " + why); });
  return checkpoint;
}

}  // namespace prowl::cli
