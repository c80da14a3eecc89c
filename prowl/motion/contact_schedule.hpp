#pragma once

#include <optional>
#include <vector>

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// A contact on one foothold over consecutive phases.
struct ContactStance {
  int contact = 0;
  int surface = 0;
  int first_phase = 0, last_phase = 0;
  std::optional<Eigen::Vector3d> foothold;  ///< given foothold, world frame [m]; otherwise the optimiser chooses

  /// True if the contact lands during the motion; otherwise it stands from the start, at its position there.
  bool lands() const { return first_phase > 0; }
};

/// A contact in the air over consecutive phases.
struct ContactSwing {
  int contact = 0;
  int first_phase = 0, last_phase = 0;
  int before = -1, after = -1;  ///< stances on either side; -1 at the start and at the end of the motion
};

/// Stances and swings of all contacts, from the phases: the only code that decides when contacts land and open.
class ContactSchedule {
 public:
  explicit ContactSchedule(const MotionProblem& problem);

  const std::vector<ContactStance>& stances() const { return stances_; }
  const std::vector<ContactSwing>& swings() const {
    return swings_;
  }  ///< every contact of the robot, also those never held

  /// A contact in the air keeps its distance of this surface at this part of the swing, 0 to 1. Unbounded surfaces
  /// count all the time. To avoid edge logic, the patch that the contact leaves counts in the first half, the patch on
  /// which it lands in the second.
  bool passes(const MotionProblem& problem, const ContactSwing& swing, int surface, double progress) const;

  /// Stance of the i-th contact of a phase; index into stances().
  int stance(int phase, int i) const { return held_[phase][i]; }
  /// The i-th contact of a phase lands at its first node.
  bool lands(int phase, int i) const;
  /// The i-th contact of a phase opens at its last node: it is not held in the phase after.
  bool opens(int phase, int i) const;

 private:
  int num_phases_;
  std::vector<ContactStance> stances_;
  std::vector<ContactSwing> swings_;
  std::vector<std::vector<int>> held_;
};

}  // namespace prowl
