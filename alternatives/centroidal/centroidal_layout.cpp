#include "alternatives/centroidal/centroidal_layout.hpp"

namespace prowl {

CentroidalColumns::CentroidalColumns(int nv, int num_contacts, bool ends_interval)
    : v(nv),
      com(2 * nv),
      com_velocity(com + 3),
      momentum(com + 6),
      contacts(com + 9),
      com_acceleration(-1),
      momentum_rate(-1),
      forces(-1),
      size(contacts + 3 * num_contacts) {
  if (!ends_interval) return;
  com_acceleration = size;
  momentum_rate = size + 3;
  forces = size + 6;
  size = forces + 3 * num_contacts;
}

CentroidalLayout::CentroidalLayout(const DiscreteProblem& discrete, const std::vector<int>& rows,
                                   const std::vector<int>& sliding_rows) {
  const MotionProblem& problem = discrete.problem;
  const int nv = problem.robot.nv();
  int num_rows = 0;
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    const MeshNode& node = discrete.nodes[k];
    const auto contacts = problem.phases[node.phase].contacts.size();
    columns_.emplace_back(nv, static_cast<int>(contacts), node.node > 0);
    nodes_.push_back(num_variables_);
    num_variables_ += columns_.back().size;
    node_rows_.push_back(num_rows);
    num_rows += rows[k];
  }
  first_shared_ = num_variables_;
  for (const Phase& phase : problem.phases) durations_.push_back(phase.duration.is_fixed() ? -1 : num_variables_++);

  link_rows_.push_back(num_rows);
  for (int k = 0; k < num_links(); ++k) {
    const MeshNode& node = discrete.nodes[k];
    const bool is_interval = node.h_out > 0.0;
    num_rows += is_interval ? nv + 9 + sliding_rows[node.phase] : 2 * nv + 3;
    link_rows_.push_back(num_rows);
  }
}

}  // namespace prowl
