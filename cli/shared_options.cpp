#include "shared_options.hpp"

namespace prowl::cli {

void add_plan_directory(CLI::App& verb, std::string& directory) {
  verb.add_option("directory", directory, "Folder that prowl plan wrote")->required()->type_name("DIR");
}

void add_package_dirs(CLI::App& verb, std::vector<std::string>& folders) {
  verb.add_option("--package-dir", folders, "Where to look for package://; may be given again")
      ->type_name("DIR")->expected(1)->take_all();
}

void add_json(CLI::App& verb, bool& json) { verb.add_flag("--json", json, "Print the result as JSON"); }

}  // namespace prowl::cli
