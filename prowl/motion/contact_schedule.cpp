#include "prowl/motion/contact_schedule.hpp"

#include <algorithm>

namespace prowl {

ContactSchedule::ContactSchedule(const MotionProblem& problem)
    : num_phases_(static_cast<int>(problem.phases.size())), held_(problem.phases.size()) {
  for (int p = 0; p < num_phases_; ++p) held_[p].resize(problem.phases[p].contacts.size());
  for (int contact = 0; contact < static_cast<int>(problem.robot.contacts().size()); ++contact) {
    int open_stance = -1, open_swing = -1;  // that of the phase before, if any
    for (int p = 0; p < num_phases_; ++p) {
      const auto& contacts = problem.phases[p].contacts;
      const auto held = std::ranges::find(contacts, contact, &PhaseContact::contact);
      if (held == contacts.end()) {
        if (open_swing < 0) {
          open_swing = static_cast<int>(swings_.size());
          swings_.push_back({.contact = contact, .first_phase = p, .before = open_stance});
        }
        swings_[open_swing].last_phase = p;
        open_stance = -1;
        continue;
      }
      if (open_stance < 0) {
        open_stance = static_cast<int>(stances_.size());
        stances_.push_back(
            {.contact = contact, .surface = held->surface, .first_phase = p, .foothold = held->foothold});
        if (open_swing >= 0) swings_[open_swing].after = open_stance;
      }
      stances_[open_stance].last_phase = p;
      held_[p][held - contacts.begin()] = open_stance;
      open_swing = -1;
    }
  }
}

bool ContactSchedule::passes(const MotionProblem& problem, const ContactSwing& swing, int surface,
                             double progress) const {
  constexpr double kRounding = 1e-9;  // a node in the middle belongs to both halves
  const auto is_of = [&](int stance) { return stance >= 0 && stances_[stance].surface == surface; };
  return problem.surfaces[surface].patch.empty() || (is_of(swing.before) && progress <= 0.5 + kRounding) ||
         (is_of(swing.after) && progress >= 0.5 - kRounding);
}

bool ContactSchedule::lands(int phase, int i) const {
  const ContactStance& held = stances_[stance(phase, i)];
  return held.lands() && held.first_phase == phase;
}

bool ContactSchedule::opens(int phase, int i) const {
  return phase + 1 < num_phases_ && stances_[stance(phase, i)].last_phase == phase;
}

}  // namespace prowl
