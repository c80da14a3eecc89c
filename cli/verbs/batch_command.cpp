#include <memory>
#include <string>

#include "cli/options/shared_options.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/python_verb.hpp"

namespace prowl::cli {

void add_batch_command(CLI::App& app, int& status) {
  struct BatchArguments : PythonVerb {
    int workers = 0;
    std::string scheduler, ca, certificate, key;
  };
  const auto arguments = std::make_shared<BatchArguments>();
  CLI::App* const verb = app.add_subcommand("batch", "Make a library of motions: many plans of one task");
  verb->add_option("job", arguments->directory, "Job file (docs/batch.md)")->required()->type_name("JOB.toml");
  add_folder(*verb, "--out", arguments->out, "Folder of the library; default: out/JOB. An incomplete one is resumed");
  verb->add_option("--workers", arguments->workers, "Processes on this machine; default: one a core")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  verb->add_option("--scheduler", arguments->scheduler, "Address of a running Dask scheduler, which has workers")
      ->type_name("ADDRESS")
      ->excludes("--workers");
  verb->add_option("--tls-ca", arguments->ca, "Certificate of the authority, for a scheduler with tls://")
      ->type_name("FILE");
  verb->add_option("--tls-cert", arguments->certificate, "Certificate of this client")->type_name("FILE");
  verb->add_option("--tls-key", arguments->key, "Its key")->type_name("FILE");
  add_python(*verb, arguments->python, "dask, distributed and pyarrow");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  set_footer(*verb,
             {"prowl batch examples/jobs/crouches.toml --out out/crouches",
              "prowl batch examples/jobs/crouches.toml --scheduler tcp://10.0.0.1:8786"},
             "0 if all motions are done, kept or failed; 2 bad input, 4 files, 6 some took longer than the job allows. "
             "Run it again to resume.");
  verb->callback([arguments, verb, &status] { status = run_python_verb(*verb, *arguments); });
}

void add_library_command(CLI::App& app, int& status) {
  struct LibraryArguments : PythonVerb {
    int motion = 0;
    double rate = 0.0;
    std::string page, format;
  };
  const auto arguments = std::make_shared<LibraryArguments>();
  CLI::App* const verb = app.add_subcommand("library", "Show what a library of motions contains");
  verb->add_option("directory", arguments->directory, "Folder of the library")->required()->type_name("LIB");
  verb->add_option("--motion", arguments->motion, "Plan this motion again, into --out, for its report or simulation")
      ->check(CLI::NonNegativeNumber)
      ->type_name("INDEX");
  verb->add_option("--page", arguments->page,
                   "Write a page with the motions by outcome and their margins, to this file")
      ->type_name("FILE");
  verb->add_option("--format", arguments->format, "Write the motions for trainers, into --out: mjlab or lerobot")
      ->check(one_of({"mjlab", "lerobot"}))
      ->excludes("--motion")
      ->excludes("--page")
      ->type_name("FORMAT");
  verb->add_option("--rate", arguments->rate, "Samples per second for --format; default: those of the library")
      ->check(CLI::PositiveNumber)
      ->needs("--format")
      ->type_name("HZ");
  add_folder(*verb, "--out", arguments->out,
             "Folder for that plan or those files; default: LIB/../motion_INDEX, LIB/../LIB_FORMAT");
  add_python(*verb, arguments->python, "pyarrow");
  add_json(*verb, arguments->json);
  set_footer(*verb,
             {"prowl library out/crouches",
              "prowl library out/crouches --motion 12 --out out/twelve && prowl report out/twelve",
              "prowl library out/crouches --page out/crouches.html",
              "prowl library out/crouches --format mjlab --out out/crouches_mjlab"},
             "0 if it was read, 2 bad input, 4 files.");
  verb->callback([arguments, verb, &status] { status = run_python_verb(*verb, *arguments); });
}

}  // namespace prowl::cli
