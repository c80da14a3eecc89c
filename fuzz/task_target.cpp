// A task file with its scene ([[surface]]), for the robots of sample.hpp.
#include "input.hpp"
#include "prowl/task_file/task_file.hpp"
#include "sample.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prowl;
  const SourceText task{"task.toml", fuzz::text_of(data, size)};
  const StoredFiles stored{.urdf = SourceText{"small.urdf", fuzz::kUrdf},
                           .reference = SourceText{"reference.csv", fuzz::kReference}};
  for (const std::string& robot : {fuzz::kRobot, fuzz::kQuadruped}) {
    fuzz::takes_or_refuses([&] { parse_task(task, {"robot.toml", robot}, {}, {}, stored); });
  }
  return 0;
}
