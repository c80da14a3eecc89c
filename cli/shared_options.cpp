#include "shared_options.hpp"

#include "output.hpp"

namespace prowl::cli {

void add_plan_directory(CLI::App& verb, std::string& directory) {
  verb.add_option("directory", directory, "Folder that prowl plan wrote")->required()->type_name("DIR");
}

void add_package_dirs(CLI::App& verb, std::vector<std::string>& folders) {
  verb.add_option("--package-dir", folders, "Where to look for package://; may be given again")
      ->type_name("DIR")->expected(1)->take_all();
}

void add_json(CLI::App& verb, bool& json) {
  verb.add_flag("--json", json, "Print one JSON object on stdout, for errors too");
  verb.add_flag_callback("--quiet", be_quiet, "No progress on stderr; warnings and errors stay");
}

void set_footer(CLI::App& verb, const std::vector<std::string>& examples, const std::string& exit_status) {
  std::string text = "Examples:\n";
  for (const std::string& example : examples) text += "  " + example + "\n";
  verb.footer(text + "\nExit status: " + exit_status);
}

}  // namespace prowl::cli
