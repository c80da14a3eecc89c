#include "checkpoint_option.hpp"

#include <fmt/format.h>

#include "output.hpp"
#include "prowl/error.hpp"
#include "prowl/transcription/mesh_levels.hpp"
#include "shared_options.hpp"

namespace prowl::cli {

void add_checkpoint(CLI::App& verb, CheckpointArguments& arguments) {
  CLI::Option* const folder =
      verb.add_option("--checkpoint", arguments.folder, "Keep the best iterate in this folder while it solves, for --resume")
          ->type_name("DIR");
  verb.add_option("--checkpoint-every", arguments.every,
                  fmt::format("Seconds between two that are written; default {:g}, 0: each that is better", arguments.every))
      ->check(nonnegative_number())->type_name("S")->needs(folder);
  verb.add_option("--resume", arguments.resume, "Go on from this checkpoint, or from a plan that was not finished, of the same task")
      ->type_name("DIR");
}

void resume(const CheckpointArguments& arguments, const PackageSearch& search, bool is_refined, Task& task,
            PlanOptions& options) {
  if (arguments.resume.empty()) return;
  PlanRecord record = read_plan(arguments.resume, search);
  std::vector<MotionProblem> meshes;
  if (!is_refined) meshes = options.coarse_first ? mesh_levels(task.problem) : std::vector{task.problem};
  try {
    check_resumable(record, task, meshes);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--resume {}: {}", arguments.resume, error.what()));
  }
  if (is_refined) task.problem = std::move(record.task.problem);
  options.start_from = std::move(record.plan.trajectory);
  options.resume = true;
}

std::unique_ptr<Checkpoint> write_checkpoints(const CheckpointArguments& arguments, const std::filesystem::path& out,
                                              PlanRecord so_far, PlanOptions& options) {
  if (arguments.folder.empty()) return nullptr;
  const auto place = [](const std::filesystem::path& path) { return std::filesystem::weakly_canonical(std::filesystem::absolute(path) / ""); };
  if (place(arguments.folder) == place(out)) {
    throw InputError(fmt::format("--checkpoint {}: is where the plan goes, and may hold an earlier one; need another folder", arguments.folder));
  }
  auto checkpoint = std::make_unique<Checkpoint>(arguments.folder, arguments.every, std::move(so_far));
  checkpoint->watch(options, [](const std::string& why) {
    print_message(fmt::format("note: no checkpoint, planning goes on: {}\n", why));
  });
  return checkpoint;
}

}  // namespace prowl::cli
