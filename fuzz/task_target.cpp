// A task file with its scene ([[surface]]), for the robot of sample.hpp.
#include "input.hpp"
#include "prowl/io/task_file.hpp"
#include "sample.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prowl;
  const SourceText task{"task.toml", fuzz::text_of(data, size)};
  const SourceText robot{"robot.toml", fuzz::kRobot}, urdf{"small.urdf", fuzz::kUrdf};
  fuzz::takes_or_refuses([&] { parse_task(task, robot, {}, {}, urdf); });
  return 0;
}
