#include <memory>
#include <string>
#include <vector>

#include "cli/options/shared_options.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/python_verb.hpp"
#include "prowl/plan_folder/export_files.hpp"

namespace prowl::cli {

void add_export_command(CLI::App& app, int& status) {
  struct ExportArguments : PythonVerb {
    std::vector<std::string> formats;
    double rate = 0.0;
    bool simulation = false;
  };
  const auto arguments = std::make_shared<ExportArguments>();
  std::vector<std::string> names;
  for (const ExportFormat& format : export_formats()) names.push_back(format.name);
  CLI::App* const verb = app.add_subcommand("export", "Write a plan or its simulation for other programs");
  add_plan_directory(*verb, arguments->directory);
  verb->add_option("--format", arguments->formats,
                   "One or more formats, comma-separated: " + CLI::detail::join(names, ", "))
      ->required()
      ->delimiter(',')
      ->check(one_of(names))
      ->type_name("FORMAT");
  add_folder(*verb, "--out", arguments->out, "Folder for the files; default: DIR/exports");
  verb->add_option("--rate", arguments->rate,
                   "Samples per second; default: the nodes of the plan, all rows of the simulation")
      ->type_name("HZ");
  verb->add_flag("--simulation", arguments->simulation,
                 "Export the simulated motion of simulate.csv instead of the planned one");
  add_python(*verb, arguments->python, "numpy, for mcap also mcap and mcap-ros2-support");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  add_allow_libraries(*verb, arguments->allow_libraries);
  set_footer(*verb,
             {"prowl export out/hyq_crouch --format csv,npz --rate 500",
              "prowl export out/hyq_crouch --format mcap --simulation"},
             "0 if the files are written, 2 bad input, 4 files. Contents: docs/exports.md.");
  verb->callback([arguments, verb, &status] { status = run_python_verb(*verb, *arguments); });
}

}  // namespace prowl::cli
