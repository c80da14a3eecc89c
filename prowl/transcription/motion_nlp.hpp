#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/stored_nlp.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/hessian_kind.hpp"

namespace prowl {

/// A motion problem on a mesh as a nonlinear program, whatever its variables and rows are.
class MotionNlp : public StoredNlp {
 public:
  MotionNlp(const MotionNlp&) = delete;
  MotionNlp& operator=(const MotionNlp&) = delete;

  /// From a motion with one point a node of the mesh.
  virtual Eigen::VectorXd pack(const Trajectory& trajectory) const = 0;
  /// At the nodes of the mesh, with contact forces, and how it runs between them. Throws NumericalError if z is not
  /// finite.
  virtual Trajectory unpack(const Eigen::VectorXd& z) = 0;

  virtual void use_hessian(HessianKind kind) = 0;  ///< exact, if not said otherwise

 protected:
  /// `discrete` must outlive the program.
  explicit MotionNlp(const DiscreteProblem& discrete) : discrete_(discrete) {}

  const MotionProblem& problem() const { return discrete_.problem; }
  const MeshNode& mesh_node(int k) const { return discrete_.nodes[k]; }
  int num_nodes() const { return discrete_.num_nodes(); }
  int phase_of(int k) const { return mesh_node(k).phase; }
  bool is_interval(int k) const { return discrete_.is_interval(k); }

  /// Makes sure that everything is evaluated at z: only what was not evaluated there last is evaluated again.
  void evaluate(const Eigen::VectorXd& z, bool with_derivatives);

  /// Duration of a phase, of which `variable` is the index in z; -1 if it is fixed.
  double duration(const Eigen::VectorXd& z, int phase, int variable) const {
    return variable >= 0 ? z(variable) : problem().phases[phase].duration.min;
  }
  /// Time of node k of a motion with such a duration of its phase, which starts at phase_start and, at the last node,
  /// is moved to the end of the phase [s].
  double node_time(int k, double duration, double& phase_start) const;
  /// How long a phase of the motion lasts [s].
  double planned_duration(const Trajectory& motion, int phase) const;
  /// Where the contact of each stance that lands touches its surface in the motion, in surface coordinates; zero for
  /// those that do not land.
  std::vector<Eigen::Vector2d> landing_places(const Trajectory& motion) const;
  /// Appends a point to the motion, with the sign of its quaternion that goes on without a jump.
  static void append(TrajectoryPoint point, Trajectory& motion);

  const DiscreteProblem& discrete_;

 private:
  virtual void evaluate_all(const Eigen::VectorXd& z, bool with_derivatives) = 0;

  Eigen::VectorXd evaluated_at_;
  bool have_derivatives_ = false;
};

}  // namespace prowl
