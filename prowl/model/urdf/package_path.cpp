#include "prowl/model/urdf/package_path.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prowl/error.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> ancestors(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (fs::path f = folder; !f.empty(); f = f.parent_path()) {
    folders.push_back(f);
    if (f == f.parent_path()) break;
  }
  return folders;
}

/// Shared data of the wheels in folder/.venv, for each Python in it.
std::vector<fs::path> wheel_shares(const fs::path& folder) {
  std::vector<fs::path> shares;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder / ".venv" / "lib", error)) {
    if (!entry.path().filename().string().starts_with("python3")) continue;
    const fs::path share = entry.path() / "site-packages" / "cmeel.prefix" / "share";
    if (fs::is_directory(share, error)) shares.push_back(share);
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

std::vector<fs::path> folders_with_venv(const fs::path& robot_file, const PackageSearch& search) {
  std::vector<fs::path> folders = ancestors(robot_file.parent_path());
  const auto add = [&folders](const fs::path& folder) {
    if (std::find(folders.begin(), folders.end(), folder) == folders.end()) folders.push_back(folder);
  };
  for (const fs::path& folder : ancestors(search.working_directory)) add(folder);
  if (!search.clone.empty()) add(search.clone);
  return folders;
}

std::vector<fs::path> folders_to_search(const fs::path& robot_file, const std::vector<fs::path>& package_dirs,
                                        const PackageSearch& search) {
  std::vector<fs::path> folders = package_dirs;
  folders.insert(folders.end(), search.folders.begin(), search.folders.end());
  const std::vector<fs::path> above = ancestors(robot_file.parent_path());
  folders.insert(folders.end(), above.begin(), above.end());
  for (const fs::path& folder : folders_with_venv(robot_file, search)) {
    const std::vector<fs::path> shares = wheel_shares(folder);
    folders.insert(folders.end(), shares.begin(), shares.end());
  }
  folders.insert(folders.end(), search.installed.begin(), search.installed.end());
  return folders;
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

}  // namespace

fs::path resolve_uri(const std::string& uri, const fs::path& robot_file, const std::vector<fs::path>& package_dirs,
                     const PackageSearch& search) {
  const std::string scheme = "package://";
  const fs::path robot_path = fs::absolute(robot_file).lexically_normal();
  if (!uri.starts_with(scheme)) {
    if (uri.find("://") != std::string::npos) {
      throw InputError(fmt::format("\"{}\" is not allowed; need a path or package://NAME/PATH", shown(uri)));
    }
    const fs::path path = (robot_path.parent_path() / uri).lexically_normal();
    if (!is_file(path)) throw InputError(fmt::format("no such file: {}", path.string()));
    return path;
  }
  const std::string inside = uri.substr(scheme.size());
  const std::string package = inside.substr(0, inside.find('/'));
  if (package.empty() || package.size() + 1 >= inside.size()) {
    throw InputError(fmt::format("\"{}\" is not allowed; need package://NAME/PATH", uri));
  }
  const std::string rest = inside.substr(package.size() + 1);
  const fs::path normal = fs::path(rest).lexically_normal();
  if (package == "." || package == ".." || normal.is_absolute() || *normal.begin() == "..") {
    throw InputError(fmt::format("\"{}\" leaves its package; need package://NAME/PATH with PATH inside NAME", uri));
  }
  std::string tried;
  for (const fs::path& folder : folders_to_search(robot_path, package_dirs, search)) {
    fs::path base = fs::absolute(folder).lexically_normal();
    if (!base.has_filename()) base = base.parent_path();  // "folder/"
    fs::path in_folder = base / package / rest;
    if (is_file(in_folder)) return in_folder;
    if (base.filename() == package && is_file(base / rest)) return base / rest;
    tried += "\n  " + in_folder.string();
  }
  std::string venvs;
  for (const fs::path& folder : folders_with_venv(robot_path, search)) {
    const fs::path venv = folder / ".venv";
    std::error_code error;
    venvs += "\n  " + venv.string() + (fs::is_directory(venv, error) ? "" : " (not there)");
  }
  throw InputError(
      fmt::format("\"{}\" not found; give its folder with package_dirs or --package-dir. Tried:{}\n"
                  "and the wheels in:{}",
                  uri, tried, venvs));
}

}  // namespace prowl
