// The seeds of the fuzz targets are taken, so that mutations start behind the readers' first checks; what fuzzers found
// (found*) is taken or refused, and nothing else.
#include <gmock/gmock.h>

#include <filesystem>
#include <functional>
#include <map>

#include "fuzz/sample.hpp"
#include "prowl/error.hpp"
#include "prowl/online/script_file.hpp"
#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/plan_folder/plan_json.hpp"
#include "prowl/plan_folder/trajectory_csv.hpp"
#include "prowl/report_page/online_wish.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "prowl/task_file/task_file.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl {
namespace {

namespace fs = std::filesystem;

const SourceText kUrdf{"small.urdf", fuzz::kUrdf};
const SourceText kRobot{"robot.toml", fuzz::kRobot};

void read_urdf(const SourceText& source) {
  RobotDescription description;
  description.name = "robot";
  description.urdf = source.path;
  description.urdf_text = source.text;
  RobotModel{description};
}

using Read = std::function<void(const SourceText&)>;
const std::map<std::string, Read> kReaders = {
    {"urdf", read_urdf},
    {"robot", [](const SourceText& s) { load_robot(s, {}, {.needs_contacts = false, .urdf_copy = kUrdf}); }},
    {"task",
     [](const SourceText& s) {
       const bool walks = s.text.find("[gait]") != std::string::npos;
       parse_task(s, walks ? SourceText{"robot.toml", fuzz::kQuadruped} : kRobot, {}, {}, {.urdf = kUrdf});
     }},
    {"script", [](const SourceText& s) { read_script(s); }},
    {"wish", [](const SourceText& s) { parse_wish(s.text); }},
    {"plan", [](const SourceText& s) { plan_from_json(s, {}); }},
    {"trajectory",
     [](const SourceText& s) {
       const Task task = parse_task({"task.toml", fuzz::kTask}, kRobot, {}, {}, {.urdf = kUrdf});
       trajectory_from_csv(task.problem, task.mesh, s);
     }},
    {"tracker", [](const SourceText& s) {
       try {
         Tracker::read(s.path.string());
       } catch (const TrackerError& error) {
         throw InputError(error.what());
       }
     }}};

TEST(FuzzSeeds, AreTaken) {
  for (const auto& [target, read] : kReaders) {
    int taken = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(PROWL_SOURCE_DIR) / "fuzz/corpus" / target)) {
      const SourceText seed = read_text_file(entry.path());
      if (entry.path().filename().string().starts_with("found")) {
        try {
          read(seed);
        } catch (const Error&) {
        }
      } else {
        EXPECT_NO_THROW(read(seed)) << entry.path();
        ++taken;
      }
    }
    EXPECT_GT(taken, 0) << target;
  }
}

}  // namespace
}  // namespace prowl
