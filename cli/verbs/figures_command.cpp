#include <memory>
#include <string>

#include "cli/options/shared_options.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/python_verb.hpp"

namespace prowl::cli {

void add_figures_command(CLI::App& app, int& status) {
  struct FiguresArguments : PythonVerb {
    std::string joint;
  };
  const auto arguments = std::make_shared<FiguresArguments>();
  CLI::App* const verb = app.add_subcommand("figures", "Draw a plan, its gains and its simulation");
  add_plan_directory(*verb, arguments->directory);
  add_folder(*verb, "--out", arguments->out, "Folder for the figures; default: DIR/figures");
  verb->add_option("--joint", arguments->joint,
                   "Joint for the plot of gains; default: the first knee, or the last joint of the first leg")
      ->type_name("NAME");
  add_python(*verb, arguments->python, "numpy, scipy and matplotlib");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  add_allow_libraries(*verb, arguments->allow_libraries);
  set_footer(*verb,
             {"prowl simulate out/hyq_crouch && prowl figures out/hyq_crouch",
              "prowl figures out/hyq_crouch --joint lf_hfe_joint --out figures"},
             "0 if the figures are drawn, 2 bad input, 4 files.");
  verb->callback([arguments, verb, &status] { status = run_python_verb(*verb, *arguments); });
}

}  // namespace prowl::cli
