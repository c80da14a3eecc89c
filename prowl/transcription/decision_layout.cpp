#include "prowl/transcription/decision_layout.hpp"

namespace prowl {

DecisionLayout::DecisionLayout(const Mesh& mesh, int nv, std::vector<int> contacts_per_phase)
    : nv_(nv), num_nodes_(static_cast<int>(mesh.nodes.size())) {
  int row = 0;
  for (const MeshNode& node : mesh.nodes) {
    const int contacts = contacts_per_phase[static_cast<std::size_t>(node.phase)];
    node_rows_.push_back(row);
    friction_counts_.push_back(contacts);
    row += nv_ + contacts;
  }
  first_link_row_ = row;
  num_constraints_ = row + 2 * nv_ * num_links();
}

}  // namespace prowl
