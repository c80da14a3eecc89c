#include "prowl/session/environment.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <sstream>

#include "prowl/error.hpp"
#include "prowl/kernels/dense_kernels.hpp"
#include "prowl/simulation/physics.hpp"
#include "prowl/solvers/foreign/library_release.hpp"
#include "prowl/solvers/make_solver.hpp"

namespace prowl {
namespace {

std::vector<std::filesystem::path> path_list(const char* variable) {
  std::vector<std::filesystem::path> paths;
  const char* const value = std::getenv(variable);
  std::istringstream text(value ? value : "");
  for (std::string path; std::getline(text, path, ':');) {
    if (!path.empty()) paths.emplace_back(path);
  }
  return paths;
}

}  // namespace

PackageSearch package_search(const std::filesystem::path& program, const std::vector<std::string>& package_dirs) {
  PackageSearch search;
  search.folders.assign(package_dirs.begin(), package_dirs.end());
  for (const auto& prefix : path_list("AMENT_PREFIX_PATH")) search.folders.push_back(prefix / "share");
  for (const auto& path : path_list("ROS_PACKAGE_PATH")) search.folders.push_back(path);
  std::error_code ignored;  // the working directory may have been removed
  search.working_directory = std::filesystem::current_path(ignored);
  // From CLONE/build/bin/prowl or CLONE/build/python/prowl/ the clone follows without a compiled-in
  // path. In a wheel the prefix is site-packages, which contains the share folder of Pinocchio's
  // wheels.
  const std::filesystem::path folder = program.parent_path();
  const std::filesystem::path prefix = folder.filename() == "bin" ? folder.parent_path() : folder;
  search.clone = prefix.parent_path();
  if (search.clone.filename() == "python") search.clone = search.clone.parent_path().parent_path();
  search.installed = {prefix / "share", prefix.parent_path() / "cmeel.prefix" / "share"};
  return search;
}

std::string processor_features() {
  std::string features;
  if (__builtin_cpu_supports("avx")) features += " AVX";
  if (__builtin_cpu_supports("avx2")) features += " AVX2";
  if (__builtin_cpu_supports("fma")) features += " FMA";
  return features.empty() ? "" : features.substr(1);
}

std::optional<std::string> why_no_mujoco() {
  return why_missing_instructions("libmujoco.so", "AVX", processor_features());
}

void check_mujoco() {
  if (const auto reason = why_no_mujoco())
    throw InputError(*reason + ": prowl simulate --engine rollout does not need it");
}

std::vector<std::filesystem::path> foreign_libraries() {
  std::vector<std::filesystem::path> found;
  for (const std::filesystem::path& folder : path_list("LD_LIBRARY_PATH")) {
    std::error_code ignored;
    for (const std::filesystem::directory_entry& file : std::filesystem::directory_iterator(folder, ignored)) {
      const std::string name = file.path().filename().string();
      if (name.starts_with("libpinocchio") || name.starts_with("libmujoco")) found.push_back(file.path());
    }
  }
  std::ranges::sort(found);
  return found;
}

std::map<std::string, std::string> versions() {
  return {{"prowl", PROWL_VERSION},
          {"MuJoCo", Physics::version()},
          {"Pinocchio", PROWL_PINOCCHIO_VERSION},
          {"vector instructions", dense_kernels().instruction_set},
          {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)}};
}

std::map<std::string, std::string> versions_with(const std::string& solver) {
  std::map<std::string, std::string> all = versions();
  const std::unique_ptr<NlpSolver> made = make_solver(solver);
  all[made->name()] = made->version();
  return all;
}

std::map<std::string, std::string> all_versions() {
  std::map<std::string, std::string> all = versions();
  for (const std::string& name : solver_names()) {
    if (const auto solver = make_solver_if_installed(name)) all[solver->name()] = solver->version();
  }
  return all;
}

}  // namespace prowl
