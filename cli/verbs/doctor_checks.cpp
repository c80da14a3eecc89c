#include "cli/verbs/doctor_checks.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "cli/process/process.hpp"
#include "cli/process/program_files.hpp"
#include "cli/verbs/python_verb.hpp"
#include "prowl/error.hpp"
#include "prowl/session/environment.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;
using State = Finding::State;

constexpr double kLeastMemory = 2.2;  // [GB], of a compiler for a file that includes Pinocchio
constexpr double kBusy = 1.5;         // load per core

/// Value of "name : value" in a table of the kernel; "" if absent.
std::string kernel_value(const char* file, const std::string& name) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(name)) continue;
    const std::size_t colon = line.find(':');
    const std::size_t begin = colon == std::string::npos ? colon : line.find_first_not_of(" \t", colon + 1);
    if (begin != std::string::npos) return line.substr(begin);
  }
  return "";
}

double memory(const std::string& name) {
  return 1e-6 * std::strtod(kernel_value("/proc/meminfo", name).c_str(), nullptr);
}  // [GB]

/// Cores that this process may use: a container or taskset may limit them.
int usable_cores() {
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  return static_cast<int>(std::thread::hardware_concurrency());
}

/// Mean number of runnable processes in the last minute.
double load() {
  double loads[1] = {0.0};
  return ::getloadavg(loads, 1) == 1 ? loads[0] : 0.0;
}

/// A verb of the Python package, and other modules that it needs.
Finding check_python_verb(const char* verb, const std::string& modules) {
  const std::string python = default_python();
  Finding finding{.area = "files", .name = verb, .text = python, .remedy = ""};
  std::string missing;
  int status = -1;
  try {
    status = run_program({python, "-c",
                          fmt::format("import importlib.util as u, sys; sys.path.insert(0, sys.argv[1])\n"
                                      "print(*[m for m in '_verb _prowl {}'.split() if u.find_spec(m) is None])",
                                      modules),
                          python_package().string()},
                         [&missing](const std::string& line) { missing = line; });
  } catch (const InputError&) {  // cannot be started
  }
  if (status == 0 && missing.empty()) return finding;
  finding.state = State::missing;
  finding.text = python + (status != 0 ? " is unusable" : " lacks " + missing);
  finding.remedy = fmt::format(
      "scripts/setup installs one in .venv and builds Prowl's modules; or use prowl {} --python PATH", verb);
  return finding;
}

Finding check_page() {
  const fs::path page = share_folder() / "report.html";
  std::error_code ignored;
  if (fs::exists(page, ignored)) return {.area = "files", .name = "report", .text = page.string(), .remedy = ""};
  return {.area = "files",
          .name = "report",
          .state = State::missing,
          .text = page.string() + " is missing",
          .remedy = "scripts/setup builds it; prowl report needs it"};
}

Finding check_robots() {
  Finding finding{.area = "files", .name = "robots", .text = {}, .remedy = ""};
  try {
    const fs::path urdf = resolve_uri("package://example-robot-data/robots/hyq_description/robots/hyq_no_sensors.urdf",
                                      fs::path("."), {}, package_search({}));
    finding.text = urdf.parent_path().parent_path().parent_path().string();
  } catch (const InputError&) {
    finding.state = State::missing;
    finding.text = "package example-robot-data not found: it contains the URDFs of robots/*.toml";
    finding.remedy =
        "scripts/setup installs it in .venv; or pip install example-robot-data, and use --package-dir FOLDER";
    finding.status = kFiles;
  }
  return finding;
}

}  // namespace

std::vector<Finding> check_build() {
  std::vector<Finding> findings;
  const bool optimised =
      std::string(PROWL_BUILD_TYPE) == "Release" || std::string(PROWL_BUILD_TYPE) == "RelWithDebInfo";
  findings.push_back(
      {.area = "build",
       .name = "prowl",
       .state = optimised ? State::ok : State::slow,
       .text = fmt::format("{}, build type {}", PROWL_VERSION, *PROWL_BUILD_TYPE == '\0' ? "none" : PROWL_BUILD_TYPE),
       .remedy =
           optimised ? "" : "at least 10 times slower; use cmake --preset release && cmake --build --preset release"});
  for (const auto& [name, version] : all_versions()) {
    if (name == "prowl") continue;
    findings.push_back({.area = "build", .name = name, .text = version, .remedy = ""});
    if (const auto reason = name == "MuJoCo" ? why_no_mujoco() : std::nullopt) {
      findings.back().state = State::missing;
      findings.back().text += ": " + *reason;
      findings.back().remedy = "prowl simulate --engine rollout does not need it";
    }
  }
  for (const std::filesystem::path& file : foreign_libraries()) {
    findings.push_back({.area = "build",
                        .name = "libraries",
                        .state = State::foreign,
                        .text = fmt::format("{} may be loaded instead of Prowl's own", file.string()),
                        .remedy = "take its folder out of LD_LIBRARY_PATH"});
  }
  return findings;
}

std::vector<Finding> check_machine() {
  std::vector<Finding> findings;
  std::string features;
  const auto add = [&features](bool has, const char* name) {
    features += fmt::format(", {} {}", has ? "has" : "no", name);
  };
  add(__builtin_cpu_supports("avx2"), "AVX2");
  add(__builtin_cpu_supports("fma"), "FMA");
  add(__builtin_cpu_supports("avx512f"), "AVX-512");
  const std::string model = kernel_value("/proc/cpuinfo", "model name");
  findings.push_back(
      {.area = "machine", .name = "processor", .text = (model.empty() ? "unknown" : model) + features, .remedy = ""});

  const int cores = usable_cores();
  const bool busy = load() > kBusy * cores;
  findings.push_back({.area = "machine",
                      .name = "cores",
                      .state = busy ? State::slow : State::ok,
                      .text = fmt::format("{}; load {:.1f}", cores, load()),
                      .remedy = busy ? "others use this machine: times are longer than Prowl's own" : ""});

  const double all = memory("MemTotal"), free = memory("MemAvailable");
  const bool little = free < kLeastMemory;
  findings.push_back(
      {.area = "machine",
       .name = "memory",
       .state = little ? State::slow : State::ok,
       .text = fmt::format("{:.1f} GB, {:.1f} GB free", all, free),
       .remedy = little ? "enough to plan; a build needs 2.2 GB for a file, or swaps: close other programs" : ""});
  return findings;
}

std::vector<Finding> check_files() {
  return {check_robots(), check_python_verb("figures", "numpy scipy matplotlib"),
          check_python_verb("export", "numpy mcap mcap_ros2"), check_page()};
}

}  // namespace prowl::cli
