#include "prowl/transcription/describe_program.hpp"

#include <fmt/format.h>

#include "prowl/trajectory/state_scale.hpp"

namespace prowl {

namespace {

/// Describes a shared variable: duration of a phase, coordinate of a foothold.
std::string describe_shared(const NodeProgram& program, int index) {
  const DiscreteProblem& discrete = program.discrete();
  const DecisionLayout& layout = program.layout();
  const MotionProblem& problem = discrete.problem;
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    if (layout.duration(static_cast<int>(p)) == index) {
      return fmt::format("phase {} '{}', duration", p + 1, problem.phases[p].name);
    }
  }
  std::size_t s = 0;
  while (layout.foothold(static_cast<int>(s)) != index && layout.foothold(static_cast<int>(s)) + 1 != index) ++s;
  const ContactStance& stance = discrete.schedule.stances()[s];
  return fmt::format("phase {} '{}', foothold coordinate {} of {} on {}", stance.first_phase + 1,
                     problem.phases[stance.first_phase].name, index - layout.foothold(static_cast<int>(s)) + 1,
                     problem.robot.contacts()[stance.contact].name, problem.surfaces[stance.surface].name);
}

}  // namespace

std::string describe_constraint(const NodeProgram& program, int row) {
  const DiscreteProblem& discrete = program.discrete();
  const DecisionLayout& layout = program.layout();
  const int nv = layout.nv();
  std::string what;
  int k = 0;
  if (row < layout.link_row(0)) {
    while (k + 1 < program.num_nodes() && row >= layout.node_row(k + 1)) ++k;
    what = program.functions(k).describe_row(discrete.nodes[k].node, row - layout.node_row(k));
  } else {
    const bool closes = row >= layout.closing_row();
    k = closes ? program.num_nodes() - 1 : (row - layout.link_row(0)) / (2 * nv);
    const int i = row - (closes ? layout.closing_row() : layout.link_row(k));
    what = coordinate_name(discrete.problem.robot, i % nv) + (i < nv ? ", position" : ", velocity") +
           (closes                    ? " at the end of the cycle"
            : discrete.is_interval(k) ? " over the interval"
                                      : " across the phase transition");
  }
  return fmt::format("{}, {}, t = {:.3f} s", discrete.describe_node(k), what, discrete.nodes[k].time);
}

std::string describe_variable(const NodeProgram& program, int index) {
  const DiscreteProblem& discrete = program.discrete();
  const DecisionLayout& layout = program.layout();
  if (index >= layout.first_shared()) return describe_shared(program, index);
  const int nv = layout.nv();
  int k = 0;
  while (index >= layout.node(k + 1)) ++k;
  const int i = index - layout.node(k);
  constexpr const char* kKinds[] = {"position", "velocity", "acceleration"};
  std::string what;
  if (i < 3 * nv) {
    what = fmt::format("{} {}", kKinds[i / nv], coordinate_name(discrete.problem.robot, i % nv));
  } else if (i < 3 * nv + layout.nu()) {
    what = "torque " + discrete.problem.robot.joint_names()[i - 3 * nv];
  } else {
    const int row = program.functions(k).chosen_rows()[index - layout.w(k)];
    const int contact = program.functions(k).contacts()[row / 3];
    what = fmt::format("force {} of {}", "xyz"[row % 3], discrete.problem.robot.contacts()[contact].name);
  }
  return fmt::format("{}, {}, t = {:.3f} s", discrete.describe_node(k), what, discrete.nodes[k].time);
}

}  // namespace prowl
