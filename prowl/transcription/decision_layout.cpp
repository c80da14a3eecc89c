#include "prowl/transcription/decision_layout.hpp"

namespace prowl {

DecisionLayout::DecisionLayout(const MotionProblem& problem, const ContactSchedule& schedule, const Mesh& mesh,
                               const std::vector<int>& num_chosen, const std::vector<int>& rows)
    : nv_(problem.robot.nv()) {
  nodes_.push_back(0);
  for (int k = 0; k < mesh.size(); ++k) {
    const int chosen = num_chosen[mesh.nodes[k].phase];
    nodes_.push_back(nodes_.back() + 3 * nv_ + nu() + chosen);
    node_rows_.push_back(num_constraints_);
    num_constraints_ += rows[k];
  }
  first_link_row_ = num_constraints_;
  num_constraints_ += 2 * nv_ * num_links();

  num_variables_ = nodes_.back();
  for (const Phase& phase : problem.phases) durations_.push_back(phase.duration.is_fixed() ? -1 : num_variables_++);
  for (const Stance& stance : schedule.stances()) {
    places_.push_back(stance.lands() ? num_variables_ : -1);
    if (stance.lands()) num_variables_ += 2;
  }
}

}  // namespace prowl
