#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "prowl/error.hpp"
#include "prowl/model/urdf/package_path.hpp"

namespace prowl::test {

/// A folder of its own for one test, removed at the end.
class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "prowl_test_XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_file(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The search path of the tests: the robots of the example-robot-data wheel.
inline PackageSearch test_search() { return {.folders = {PROWL_ROBOTS_DATA}, .working_directory = {}}; }

/// HyQ as a robot file.
inline const std::string kHyqFile = R"(name = "HyQ"
urdf = "package://example-robot-data/robots/hyq_description/robots/hyq_no_sensors.urdf"
contact = [
  { name = "lf_foot", frame = "lf_foot", radius_m = 0.02175 },
  { name = "rf_foot", frame = "rf_foot", radius_m = 0.02175 },
  { name = "lh_foot", frame = "lh_foot", radius_m = 0.02175 },
  { name = "rh_foot", frame = "rh_foot", radius_m = 0.02175 },
]
[nominal.joints]
lf_haa_joint = -0.2
lf_hfe_joint = 0.75
lf_kfe_joint = -1.5
rf_haa_joint = -0.2
rf_hfe_joint = 0.75
rf_kfe_joint = -1.5
lh_haa_joint = -0.2
lh_hfe_joint = -0.75
lh_kfe_joint = 1.5
rh_haa_joint = -0.2
rh_hfe_joint = -0.75
rh_kfe_joint = 1.5
)";

/// A task that is right; tests break one line of it.
inline const std::string kTaskFile = R"(name = "shift"
robot = "hyq.toml"
[[phase]]
name = "stand"
contacts = "all"
duration_s = 2.0
intervals = 5
[[goal]]
time_s = 2.0
base_displacement_m = [0.05, "free", -0.05]
[start]
joints = { lf_haa_joint = -0.1, rf_haa_joint = -0.1, lh_haa_joint = -0.1, rh_haa_joint = -0.1 }
[cost]
torque = 1e-3
)";

/// `text` with its only occurrence of `from` replaced. Throws if there is not exactly one: the test would check
/// nothing.
inline std::string replaced(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) {
    throw std::logic_error("not exactly one '" + from + "'");
  }
  return text.substr(0, at) + to + text.substr(at + from.size());
}

inline std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

/// The message of the Error that `action` throws; "" if it throws none.
template <typename ErrorType = InputError>
std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const ErrorType& error) {
    return error.what();
  }
  return "";
}

/// The same without `folder` in front of file names.
template <typename ErrorType = InputError>
std::string message_of(const std::filesystem::path& folder, const std::function<void()>& action) {
  std::string message = message_of<ErrorType>(action);
  const std::string prefix = folder.string() + "/";
  for (std::size_t at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) {
    message.erase(at, prefix.size());
  }
  return message;
}

}  // namespace prowl::test
