#include <memory>
#include <string>

#include "cli/options/shared_options.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/python_verb.hpp"

namespace prowl::cli {

void add_retarget_command(CLI::App& app, int& status) {
  struct RetargetArguments : PythonVerb {
    std::string robot;
    double fps = 0.0, slowest = 1.0;
  };
  const auto arguments = std::make_shared<RetargetArguments>();
  CLI::App* const verb = app.add_subcommand("retarget", "Turn a reference of base and joints into a plan with torques");
  verb->add_option("motion", arguments->directory, "CSV or npz file of the reference (docs/retarget.md)")
      ->required()
      ->type_name("MOTION");
  verb->add_option("--robot", arguments->robot, "Robot file, or name of a shipped robot")
      ->required()
      ->type_name("ROBOT");
  add_folder(*verb, "--out", arguments->out, "Folder for the plan, its task and reference; default: out/MOTION");
  verb->add_option("--fps", arguments->fps, "Samples per second of a CSV file without column names")
      ->check(CLI::PositiveNumber)
      ->type_name("HZ");
  verb->add_option("--slowest", arguments->slowest,
                   "Longest duration to try if the reference cannot be followed, as a multiple of its own; default 1")
      ->check(CLI::Range(1.0, 10.0))
      ->type_name("FACTOR");
  add_python(*verb, arguments->python, "numpy");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  set_footer(*verb,
             {"prowl retarget examples/references/go2_bow.csv --robot go2",
              "prowl retarget motion.npz --robot robots/talos.toml --slowest 1.5 --out out/dance"},
             "0 if a plan passes and follows the reference, 3 if not, with the reasons; 2 bad input, "
             "4 files.");
  verb->callback([arguments, verb, &status] { status = run_python_verb(*verb, *arguments); });
}

}  // namespace prowl::cli
