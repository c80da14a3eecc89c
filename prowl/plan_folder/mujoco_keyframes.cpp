#include "prowl/plan_folder/mujoco_keyframes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "prowl/plan_folder/mjcf_document.hpp"
#include "prowl/simulation/mujoco_state.hpp"

namespace prowl {
namespace {

using tinyxml2::XMLElement;

std::string numbers(const Eigen::VectorXd& values) { return fmt::format("{}", fmt::join(values, " ")); }

void add_keyframes(const MotionProblem& problem, const Trajectory& motion, XMLElement& root) {
  root.SetAttribute("model", fmt::format("{} {}", problem.robot.name(), problem.name).c_str());
  XMLElement* const keys = root.InsertNewChildElement("keyframe");
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    const TrajectoryPoint& point = motion.nodes[i];
    const std::string& phase = problem.phases[point.phase].name;
    XMLElement* const key = keys->InsertNewChildElement("key");
    key->SetAttribute("name", fmt::format("{}_{}", phase, i).c_str());
    key->SetAttribute("time", fmt::format("{}", point.time).c_str());
    key->SetAttribute("qpos", numbers(mujoco_qpos(point.q)).c_str());
    key->SetAttribute("qvel", numbers(mujoco_qvel(point.q, point.v)).c_str());
    key->SetAttribute("ctrl", numbers(point.tau).c_str());
  }
}

}  // namespace

std::string add_mujoco_keyframes(const std::string& model, const MotionProblem& problem, const Trajectory& motion) {
  const auto document = parse_mjcf(model, problem.robot.name());
  add_keyframes(problem, motion, *document->RootElement());
  return mjcf_text(*document);
}

std::string mujoco_keyframes_xml(const MotionProblem& problem, const Trajectory& motion,
                                 const std::string& model_file) {
  tinyxml2::XMLDocument document;
  XMLElement* const root = document.NewElement("mujoco");
  document.InsertFirstChild(root);
  root->InsertNewChildElement("include")->SetAttribute("file", model_file.c_str());
  add_keyframes(problem, motion, *root);
  return mjcf_text(document);
}

}  // namespace prowl
