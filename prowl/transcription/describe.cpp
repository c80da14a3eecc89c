#include <fmt/format.h>

#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

constexpr const char* kBaseForce[] = {"force x", "force y", "force z", "moment x", "moment y", "moment z"};
constexpr const char* kBaseMotion[] = {"x", "y", "z", "rotation x", "rotation y", "rotation z"};

std::string coordinate(const MotionProblem& problem, int i, const char* const (&base)[6]) {
  return i < 6 ? fmt::format("base {}", base[i]) : problem.robot.joint_names()[static_cast<std::size_t>(i - 6)];
}

}  // namespace

std::string Transcription::describe_node(int k) const {
  const MeshNode& node = mesh_.nodes[static_cast<std::size_t>(k)];
  return fmt::format("phase {} '{}', node {}", node.phase + 1, problem_.phases[static_cast<std::size_t>(node.phase)].name,
                     node.node);
}

std::string Transcription::describe_constraint(int row) const {
  const int nv = layout_.nv();
  std::string what;
  int k = 0;
  if (row < layout_.link_row(0)) {
    while (k + 1 < layout_.num_nodes() && row >= layout_.dynamics_row(k + 1)) ++k;
    const int i = row - layout_.dynamics_row(k);
    if (i < nv) {
      what = coordinate(problem_, i, kBaseForce) + ", equations of motion";
    } else {
      const Phase& phase = problem_.phases[static_cast<std::size_t>(mesh_.nodes[static_cast<std::size_t>(k)].phase)];
      const int contact = phase.contacts[static_cast<std::size_t>(i - nv)].contact;
      what = problem_.robot.contacts()[static_cast<std::size_t>(contact)].name + ", friction cone";
    }
  } else {
    k = (row - layout_.link_row(0)) / (2 * nv);
    const int i = row - layout_.link_row(k);
    what = coordinate(problem_, i % nv, kBaseMotion) + (i < nv ? ", position" : ", velocity") +
           (is_interval(k) ? " over the interval" : " across the phase switch");
  }
  return fmt::format("{}, {}, t = {:.3f} s", describe_node(k), what, mesh_.nodes[static_cast<std::size_t>(k)].time);
}

std::string Transcription::describe_variable(int index) const {
  const int nv = layout_.nv();
  const int k = index / layout_.node_size(), i = index % layout_.node_size();
  constexpr const char* kKinds[] = {"position", "velocity", "acceleration"};
  const std::string what = i < 3 * nv
                               ? fmt::format("{} {}", kKinds[i / nv], coordinate(problem_, i % nv, kBaseMotion))
                               : "torque " + problem_.robot.joint_names()[static_cast<std::size_t>(i - 3 * nv)];
  return fmt::format("{}, {}, t = {:.3f} s", describe_node(k), what, mesh_.nodes[static_cast<std::size_t>(k)].time);
}

}  // namespace prowl
