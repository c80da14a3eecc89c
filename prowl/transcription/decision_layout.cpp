#include "prowl/transcription/decision_layout.hpp"

namespace prowl {

DecisionLayout::DecisionLayout(const DiscreteProblem& discrete, const std::vector<int>& num_chosen,
                               const std::vector<int>& rows)
    : nv_(discrete.problem.robot.nv()) {
  nodes_.push_back(0);
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    const int chosen = num_chosen[discrete.nodes[k].phase];
    nodes_.push_back(nodes_.back() + 3 * nv_ + nu() + chosen);
    node_rows_.push_back(num_constraints_);
    num_constraints_ += rows[k];
  }
  first_link_row_ = num_constraints_;
  num_constraints_ += 2 * nv_ * num_links();
  first_closing_row_ = num_constraints_;
  if (discrete.problem.cycle) num_constraints_ += 2 * nv_;

  num_variables_ = nodes_.back();
  for (const Phase& phase : discrete.problem.phases)
    durations_.push_back(phase.duration.is_fixed() ? -1 : num_variables_++);
  for (const ContactStance& stance : discrete.schedule.stances()) {
    footholds_.push_back(stance.lands() ? num_variables_ : -1);
    if (stance.lands()) num_variables_ += 2;
  }
}

}  // namespace prowl
