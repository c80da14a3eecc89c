#pragma once

#include <vector>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/guess/posture_path.hpp"
#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// Where the contacts of an initial guess are: held ones at their places, those in the air between them.
///
/// A contact that lands does so where the task puts it, else under the place on the robot where the start has it: the
/// start's contact, carried along with the base to the middle of the stance, then dropped on its surface. In the air a
/// contact goes from place to place in an arc over both. One that never lands again, or was never held, keeps the
/// posture of its leg.
class ContactPath {
 public:
  ContactPath(const DiscreteProblem& discrete, const PosturePath& posture);  ///< which must outlive it

  /// Places of the contacts that a phase holds, in its order.
  std::vector<Eigen::Vector3d> held_places(int phase) const;

  /// Of node k of the mesh.
  std::vector<ContactTarget> targets(int k) const;

 private:
  struct Span {
    double start, end;  ///< [s]
  };
  Span span(int first_phase, int last_phase) const;

  const DiscreteProblem& discrete_;
  std::vector<Eigen::Vector3d> places_;  ///< one a stance, of the contact point: its radius above the surface
};

}  // namespace prowl
