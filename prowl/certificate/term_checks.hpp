#pragma once

#include <memory>
#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

inline constexpr const char* kTermCheck = "term '";  ///< names of the checks begin with it, the term's name follows

/// Checks the limits of the user's terms, at all points of their spans. What a term reads comes from Pinocchio's
/// forward kinematics and from the true forces, not from the planner's.
class TermChecks {
 public:
  /// Keeps a reference to the problem.
  explicit TermChecks(const DiscreteProblem& discrete);
  ~TermChecks();

  /// `force`: the true forces at the point, 3 per contact of the robot; `left`: index of the node before the point's
  /// mesh interval; `node`: that of the node at the point, -1 if none.
  void record(const TrajectoryPoint& point, const Eigen::VectorXd& force, int left, int node);
  /// One check for each term with a limit: "term 'hand'", in its unit.
  void append_to(std::vector<CertificateCheck>& checks) const;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;  ///< null without terms, which need no data of Pinocchio
};

}  // namespace prowl
