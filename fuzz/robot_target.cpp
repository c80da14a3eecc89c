// A robot file, with the URDF of sample.hpp: in a folder that is not there, so that package:// finds no other.
#include "input.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "sample.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prowl;
  const SourceText source{"/nowhere/robot.toml", fuzz::text_of(data, size)};
  const SourceText urdf{"small.urdf", fuzz::kUrdf};
  fuzz::takes_or_refuses([&] { load_robot(source, {}, {.needs_contacts = false, .urdf_copy = urdf}); });
  return 0;
}
