#pragma once

#include <vector>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/guess/posture_path.hpp"
#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// Positions of the contacts in an initial guess: on their footholds, and in the air between them.
///
/// A contact lands on its given foothold. Without one, its start position is carried along with the base to the middle
/// of the stance, or is that of the reference, and dropped on the surface. In the air a contact moves from foothold to
/// foothold in an arc above both. One that never lands again, or never stood, keeps the posture of its leg.
class ContactPath {
 public:
  ContactPath(const DiscreteProblem& discrete, const PosturePath& posture);  ///< `discrete` must outlive it

  /// Positions of the contacts that a phase holds, in its order, world frame [m].
  std::vector<Eigen::Vector3d> held_footholds(int phase) const;

  std::vector<ContactTarget> targets(int k) const;  ///< at node k of the mesh

 private:
  struct Span {
    double start, end;  ///< [s]
  };
  Span span(int first_phase, int last_phase) const;

  const DiscreteProblem& discrete_;
  std::vector<Eigen::Vector3d> footholds_;  ///< of the contact point in each stance: its radius above the surface
};

}  // namespace prowl
