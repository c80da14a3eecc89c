#include <fmt/format.h>

#include "alternatives/centroidal/centroidal_nlp.hpp"
#include "prowl/trajectory/state_scale.hpp"

namespace prowl {

namespace {

/// Group of entry i, and its index within the group.
std::pair<RowGroup, int> group_of(const std::vector<RowGroup>& groups, int i) {
  std::size_t g = 0;
  for (; i >= groups[g].count; ++g) i -= groups[g].count;
  return {groups[g], i};
}

}  // namespace

std::vector<RowGroup> CentroidalNlp::variable_groups(int k) const {
  const CentroidalColumns& at = layout_.columns(k);
  const int nv = problem().robot.nv(), num_contact_coordinates = 3 * static_cast<int>(node(k).contact_names().size());
  std::vector<RowGroup> groups = {{"q", nv}, {"v", nv}, {"r", 3}, {"r'", 3}, {"h", 3}, {"c", num_contact_coordinates}};
  if (at.ends_interval()) groups.insert(groups.end(), {{"r''", 3}, {"h'", 3}, {"f", num_contact_coordinates}});
  return groups;
}

std::vector<RowGroup> CentroidalNlp::constraint_groups(int k) const {
  std::vector<RowGroup> groups = node(k).row_groups(mesh_node(k).node);
  if (k == 0) return groups;
  const int nv = problem().robot.nv();
  const std::vector<RowGroup> link =
      is_interval(k - 1) ? CentroidalInterval::row_groups(nv, static_cast<int>(node(k).contacts().sliding.size()))
                         : std::vector<RowGroup>{{"q across the phase transition", nv},
                                                 {"v across the phase transition", nv},
                                                 {"r' across the phase transition", 3}};
  groups.insert(groups.end(), link.begin(), link.end());
  return groups;
}

std::string CentroidalNlp::describe_constraint(int row) const {
  int k = 0;
  std::string what;
  if (row < layout_.link_row(0)) {
    while (k + 1 < layout_.num_nodes() && row >= layout_.node_row(k + 1)) ++k;
    what = node(k).describe_row(mesh_node(k).node, row - layout_.node_row(k));
  } else {
    while (row >= layout_.link_row(k + 1)) ++k;
    ++k;  // the node that the interval ends in
    const std::vector<RowGroup> all = constraint_groups(k);
    const auto own = static_cast<std::ptrdiff_t>(node(k).row_groups(mesh_node(k).node).size());
    const auto [group, i] = group_of({all.begin() + own, all.end()}, row - layout_.link_row(k - 1));
    if (group.name == "contacts do not slide") {
      what = node(k).contacts().sliding[i].what;
    } else {
      what = fmt::format("{}, {}", group.name,
                         group.count == 3 ? std::string(1, "xyz"[i]) : coordinate_name(problem().robot, i));
    }
  }
  return fmt::format("{}, {}, t = {:.3f} s", discrete_.describe_node(k), what, mesh_node(k).time);
}

std::string CentroidalNlp::describe_variable(int index) const {
  for (std::size_t p = 0; p < problem().phases.size(); ++p) {
    if (layout_.duration(static_cast<int>(p)) != index) continue;
    return fmt::format("phase {} '{}', duration", p + 1, problem().phases[p].name);
  }
  int k = 0;
  while (k + 1 < layout_.num_nodes() && index >= layout_.node(k + 1)) ++k;
  const std::vector<RowGroup> groups = variable_groups(k);
  const auto [group, i] = group_of(groups, index - layout_.node(k));
  std::string which(1, "xyz"[i % 3]);
  if (group.name == "q" || group.name == "v") which = coordinate_name(problem().robot, i);
  if (group.name == "c" || group.name == "f") which += " of " + node(k).contact_names()[i / 3];
  return fmt::format("{}, {} {}, t = {:.3f} s", discrete_.describe_node(k), group.name, which, mesh_node(k).time);
}

}  // namespace prowl
