#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/set.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "prowl/error.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/plan_folder/export_files.hpp"
#include "prowl/plan_folder/figure_files.hpp"
#include "prowl/text/nearest_name.hpp"

namespace prowl::python {
namespace {

namespace nb = nanobind;
namespace fs = std::filesystem;

using Files = std::map<std::string, nb::bytes>;  ///< name -> content

std::map<std::string, std::string> contents(const Files& files) {
  std::map<std::string, std::string> texts;
  for (const auto& [name, bytes] : files) texts[name] = std::string(bytes.c_str(), bytes.size());
  return texts;
}

/// Creates the folder if missing; it may contain other files.
void write_files(const fs::path& folder, const Files& files) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw FileError(fmt::format("{}: cannot create this folder", folder.string()));
  write_files_atomically(folder, contents(files));
}

std::vector<std::string> export_format_names() {
  std::vector<std::string> names;
  for (const ExportFormat& format : export_formats()) names.push_back(format.name);
  return names;
}

}  // namespace

/// For functions of the package that write files like the command.
void bind_files(nb::module_& module) {
  module.def("check_replaceable", &check_replaceable, nb::arg("folder"), nb::arg("own_names"),
             "Raises FileError unless the folder is missing or contains only files with these names.");
  module.def(
      "write_folder",
      [](const fs::path& folder, const Files& files, const std::set<std::string>& own_names) {
        write_folder_atomically(folder, contents(files), own_names);
      },
      nb::arg("folder"), nb::arg("files"), nb::arg("own_names"),
      "Replaces the content of a folder by these files, atomically. Raises FileError if it contains files other than "
      "own_names.");
  module.def("write_files", &write_files, nb::arg("folder"), nb::arg("files"),
             "Writes files into a folder with others, each atomically.");
  module.def("figure_file_names", &figure_file_names, "Names of the files that figures() may write.");
  module.def("export_format_names", &export_format_names, "Formats of export().");
  module.def("did_you_mean", &did_you_mean, nb::arg("wrong"), nb::arg("names"),
             "End of a message: \"; did you mean 'x'?\"");
}

}  // namespace prowl::python
