#include <fmt/format.h>

#include "prowl/trajectory/state_scale.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

std::string Transcription::describe_node(int k) const {
  const MeshNode& node = mesh_.nodes[k];
  return fmt::format("phase {} '{}', node {}", node.phase + 1, problem_.phases[node.phase].name, node.node);
}

std::string Transcription::describe_place(int k) const {
  return fmt::format("{}, t = {:.3f} s", describe_node(k), mesh_node(k).time);
}

std::string Transcription::describe_constraint(int row) const {
  const int nv = layout_.nv();
  std::string what;
  int k = 0;
  if (row < layout_.link_row(0)) {
    while (k + 1 < layout_.num_nodes() && row >= layout_.node_row(k + 1)) ++k;
    what = functions(k).describe_row(mesh_node(k).node, row - layout_.node_row(k));
  } else {
    k = (row - layout_.link_row(0)) / (2 * nv);
    const int i = row - layout_.link_row(k);
    what = coordinate_name(problem_.robot, i % nv) + (i < nv ? ", position" : ", velocity") +
           (is_interval(k) ? " over the interval" : " across the phase switch");
  }
  return fmt::format("{}, {}, t = {:.3f} s", describe_node(k), what, mesh_node(k).time);
}

std::string Transcription::describe_variable(int index) const {
  if (index >= layout_.first_shared()) return describe_shared(index);
  const int nv = layout_.nv();
  int k = 0;
  while (index >= layout_.node(k + 1)) ++k;
  const int i = index - layout_.node(k);
  constexpr const char* kKinds[] = {"position", "velocity", "acceleration"};
  std::string what;
  if (i < 3 * nv) {
    what = fmt::format("{} {}", kKinds[i / nv], coordinate_name(problem_.robot, i % nv));
  } else if (i < 3 * nv + layout_.nu()) {
    what = "torque " + problem_.robot.joint_names()[i - 3 * nv];
  } else {
    const int row = functions(k).chosen_rows()[index - layout_.w(k)];
    const int contact = functions(k).contacts()[row / 3];
    what = fmt::format("force {} of {}", "xyz"[row % 3], problem_.robot.contacts()[contact].name);
  }
  return fmt::format("{}, {}, t = {:.3f} s", describe_node(k), what, mesh_node(k).time);
}

std::string Transcription::describe_shared(int index) const {
  for (std::size_t p = 0; p < problem_.phases.size(); ++p) {
    if (layout_.duration(static_cast<int>(p)) == index) {
      return fmt::format("phase {} '{}', duration", p + 1, problem_.phases[p].name);
    }
  }
  std::size_t s = 0;
  while (layout_.place(static_cast<int>(s)) != index && layout_.place(static_cast<int>(s)) + 1 != index) ++s;
  const Stance& stance = schedule_.stances()[s];
  return fmt::format("phase {} '{}', place {} of {} on {}", stance.first_phase + 1,
                     problem_.phases[stance.first_phase].name, index - layout_.place(static_cast<int>(s)) + 1,
                     problem_.robot.contacts()[stance.contact].name, problem_.surfaces[stance.surface].name);
}

}  // namespace prowl
