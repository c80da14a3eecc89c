#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/stored_nlp.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/hessian_kind.hpp"

namespace prowl {

/// A motion problem on a mesh as a nonlinear program; base of all formulations.
class MotionNlp : public StoredNlp {
 public:
  MotionNlp(const MotionNlp&) = delete;
  MotionNlp& operator=(const MotionNlp&) = delete;

  /// Decision variables of a motion with one point per node of the mesh.
  virtual Eigen::VectorXd pack(const Trajectory& trajectory) const = 0;
  /// Motion at the nodes of the mesh, with contact forces and interpolation. Throws NumericalError
  /// if z is not finite.
  virtual Trajectory unpack(const Eigen::VectorXd& z) = 0;

  virtual void use_hessian(HessianKind kind) = 0;  ///< default: exact

 protected:
  /// `discrete` must outlive the program.
  explicit MotionNlp(const DiscreteProblem& discrete) : discrete_(discrete) {}

  const MotionProblem& problem() const { return discrete_.problem; }
  const MeshNode& mesh_node(int k) const { return discrete_.nodes[k]; }
  int num_nodes() const { return discrete_.num_nodes(); }
  int phase_of(int k) const { return mesh_node(k).phase; }
  bool is_interval(int k) const { return discrete_.is_interval(k); }

  /// Evaluates at z, unless the last evaluation was there.
  void evaluate(const Eigen::VectorXd& z, bool with_derivatives);

  /// Duration of a phase [s]; `variable`: its index in z, -1 if fixed.
  double duration(const Eigen::VectorXd& z, int phase, int variable) const {
    return variable >= 0 ? z(variable) : problem().phases[phase].duration.min;
  }
  /// Time of node k [s], in a phase of this duration that starts at phase_start; the last node of
  /// the phase advances phase_start to its end.
  double node_time(int k, double duration, double& phase_start) const;
  /// Duration of a phase of the motion [s].
  double planned_duration(const Trajectory& motion, int phase) const;
  /// Foothold of each stance that lands, in surface coordinates [m]; zero for the others.
  std::vector<Eigen::Vector2d> landing_footholds(const Trajectory& motion) const;
  /// Appends a point, with the sign of its quaternion chosen for continuity.
  static void append(TrajectoryPoint point, Trajectory& motion);

  const DiscreteProblem& discrete_;

 private:
  virtual void evaluate_all(const Eigen::VectorXd& z, bool with_derivatives) = 0;

  Eigen::VectorXd evaluated_at_;
  bool have_derivatives_ = false;
};

}  // namespace prowl
