// A URDF: the check of its text, Pinocchio's model, and the shapes for reports and simulations.
#include "input.hpp"
#include "prowl/model/robot_model.hpp"
#include "prowl/model/urdf/robot_visuals.hpp"
#include "prowl/model/urdf/urdf_outline.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prowl;
  if (size == 0) return 0;  // an empty text is read from the file
  const std::string text = fuzz::text_of(data, size);
  fuzz::takes_or_refuses([&] { urdf_outline("robot.urdf", text); });
  fuzz::takes_or_refuses([&] {
    RobotDescription description;
    description.name = "robot";
    description.urdf = "robot.urdf";
    description.urdf_text = text;
    const RobotModel robot(description);
    robot_visuals(robot);
    robot_collisions(robot);
  });
  return 0;
}
