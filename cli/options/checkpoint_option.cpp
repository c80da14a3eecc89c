#include "cli/options/checkpoint_option.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/options/shared_options.hpp"
#include "cli/screen/output.hpp"
#include "prowl/error.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/mesh/mesh_levels.hpp"
#include "prowl/session/environment.hpp"

namespace prowl::cli {

namespace fs = std::filesystem;

void add_checkpoint(CLI::App& verb, CheckpointArguments& arguments) {
  CLI::Option* const folder = add_folder(verb, "--checkpoint", arguments.folder,
                                         "Keep the best iterate of a long solve in this folder, for --resume");
  folder->group(kOutputOptions);
  verb.add_option("--checkpoint-every", arguments.every,
                  fmt::format("Minimum seconds between checkpoints; default {:g}; 0 keeps each better iterate",
                              arguments.every))
      ->check(number_in(NumberRange::nonnegative()))
      ->type_name("S")
      ->needs(folder)
      ->group(kOutputOptions);
  add_folder(verb, "--resume", arguments.resume, "Continue from this checkpoint or unfinished plan of the same task")
      ->group(kSolverOptions);
}

namespace {

bool is_in(const fs::path& path, const fs::path& folder) {
  return std::ranges::mismatch(folder, path).in1 == folder.end();
}

}  // namespace

PlanRecord read_resumable(const std::string& folder, const PackageSearch& search, const OwnTerms& own_terms,
                          const PlanRequest& request, Task& task) {
  PlanRecord record = read_plan(folder, search, own_terms);
  std::vector<Mesh> meshes;
  const bool is_refined = refinement_goal(request, task).has_value();
  if (!is_refined) {
    meshes = request.coarse_first ? mesh_levels(task.problem, task.mesh) : std::vector{task.mesh};
  }
  try {
    check_resumable(record, task, meshes);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--resume {}: {}", folder, error.what()));
  }
  if (is_refined) task.mesh = record.plan.mesh;
  return record;
}

std::unique_ptr<Checkpoint> write_checkpoints(const CheckpointArguments& arguments, const std::filesystem::path& out,
                                              const Task& task, PlanRequest& request) {
  if (arguments.folder.empty()) return nullptr;
  const fs::path folder = real_path(arguments.folder), plan_folder = real_path(out);
  if (folder == plan_folder) {
    throw InputError(
        fmt::format("--checkpoint {}: this is the folder of the plan; need another folder", arguments.folder));
  }
  if (is_in(folder, plan_folder) || is_in(plan_folder, folder)) {
    throw InputError(
        fmt::format("--checkpoint {}: the plan goes to {}, and neither folder may contain the other; need a folder "
                    "beside it",
                    arguments.folder, out.string()));
  }
  if (holds_good_plan(folder)) {
    throw InputError(fmt::format("--checkpoint {}: holds a plan that passed; need another folder", arguments.folder));
  }
  const bool is_resumed = !arguments.resume.empty() && real_path(arguments.resume) == folder;
  PlanRecord so_far{.task = task,
                    .plan = {},
                    .versions = versions_with(solver_name(request)),
                    .warm_start = request.warm_start.folder};
  if (is_resumed) so_far.plan = request.warm_start.record->plan;
  if (!is_resumed && fs::exists(folder / "plan.json")) {
    print_note(fmt::format("this replaces the checkpoint in {}; --resume would continue from it", arguments.folder));
  }
  auto checkpoint = std::make_unique<Checkpoint>(arguments.folder, arguments.every, std::move(so_far));
  checkpoint->watch(request.on_iterate,
                    [](const std::string& why) { print_note("no checkpoint written, planning continues: " + why); });
  return checkpoint;
}

}  // namespace prowl::cli
