#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/test_files.hpp"

namespace prowl::test {

/// Whether the Python package is built, which does `figures` and `export`.
inline constexpr bool kHasPython = PROWL_HAS_PYTHON;

inline const std::string kPhase = R"(robot = "hyq.toml"
[[phase]]
contacts = "all"
duration_s = 2.0
intervals = 5
)";

/// HyQ stands still, by cost alone: a second of solving.
inline const std::string kHold = kPhase + R"([cost]
joint_position = 1.0
joint_velocity = 0.1
torque = 1e-3
)";

struct Outcome {
  int status = -1;
  std::string out, error;
};

/// Shell: waits, for a minute at most, until what runs in the background has written `pattern` (of grep) to the file
/// `progress`.
inline std::string until(const std::string& pattern) {
  return "for i in $(seq 6000); do grep -q '" + pattern + "' progress && break; sleep 0.01; done; ";
}
inline const std::string kIteration = " s$";  ///< ends the line of each iteration of a plan

class Command : public testing::Test {
 protected:
  Command() {
    folder_.write("hyq.toml", kHyqFile);
    folder_.write("hold.toml", kHold);
  }
  /// Runs a shell script in the test's folder, in which $prowl is the command and $dirs finds the robots. What a script
  /// runs in the background ignores Ctrl-C, but for $at_terminal, which is the command as a terminal starts it.
  Outcome run(const std::string& script) const {
    const std::string setup =
        "cd '" + folder_.path().string() +
        "'; prowl='" PROWL_COMMAND
        "'; at_terminal=\"env --default-signal=INT $prowl\"; dirs='--package-dir " PROWL_ROBOTS_DATA "'; (" +
        script + ") >.out 2>.err";
    const int status = std::system(setup.c_str());
    return {WEXITSTATUS(status), read_file(folder_.path() / ".out"), read_file(folder_.path() / ".err")};
  }
  bool written() const { return std::filesystem::exists(folder_.path() / "out"); }
  nlohmann::json plan() const { return nlohmann::json::parse(read_file(folder_.path() / "out/plan.json")); }

  TempFolder folder_;
};

}  // namespace prowl::test
