#include "prowl/plan_folder/mujoco_keyframes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include "prowl/simulation/mujoco_state.hpp"

namespace prowl {
namespace {

std::string numbers(const Eigen::VectorXd& values) { return fmt::format("{}", fmt::join(values, " ")); }

}  // namespace

std::string mujoco_keyframes_xml(const MotionProblem& problem, const Trajectory& motion,
                                 const std::string& model_file) {
  tinyxml2::XMLPrinter xml;
  xml.OpenElement("mujoco");
  xml.PushAttribute("model", fmt::format("{} {}", problem.robot.name(), problem.name).c_str());
  xml.OpenElement("include");
  xml.PushAttribute("file", model_file.c_str());
  xml.CloseElement();
  xml.OpenElement("keyframe");
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    const TrajectoryPoint& point = motion.nodes[i];
    const std::string& phase = problem.phases[point.phase].name;
    xml.OpenElement("key");
    xml.PushAttribute("name", fmt::format("{}_{}", phase, i).c_str());
    xml.PushAttribute("time", fmt::format("{}", point.time).c_str());
    xml.PushAttribute("qpos", numbers(mujoco_qpos(point.q)).c_str());
    xml.PushAttribute("qvel", numbers(mujoco_qvel(point.q, point.v)).c_str());
    xml.PushAttribute("ctrl", numbers(point.tau).c_str());
    xml.CloseElement();
  }
  xml.CloseElement();
  xml.CloseElement();
  return xml.CStr();
}

}  // namespace prowl
