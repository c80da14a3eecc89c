#include "prowl/transcription/motion_nlp.hpp"

#include <utility>

#include "prowl/dynamics/rigid_body_terms.hpp"

namespace prowl {

using Eigen::VectorXd;

void MotionNlp::evaluate(const VectorXd& z, bool with_derivatives) {
  if (evaluated_at_.size() == z.size() && evaluated_at_ == z && (have_derivatives_ || !with_derivatives)) return;
  evaluated_at_.resize(0);  // in case the evaluation throws
  evaluate_all(z, with_derivatives);
  evaluated_at_ = z;
  have_derivatives_ = with_derivatives;
}

double MotionNlp::node_time(int k, double duration, double& phase_start) const {
  const PhaseMesh& mesh = discrete_.phase_mesh_of(k);
  const double time = phase_start + mesh.node_time(mesh_node(k).node, duration);
  if (mesh_node(k).node == mesh.intervals()) phase_start = time;
  return time;
}

double MotionNlp::planned_duration(const Trajectory& motion, int phase) const {
  const Mesh& mesh = discrete_.mesh;
  return motion.nodes[mesh.last_node(phase)].time - motion.nodes[mesh.first_node(phase)].time;
}

std::vector<Eigen::Vector2d> MotionNlp::landing_footholds(const Trajectory& motion) const {
  RigidBodyTerms terms(problem().robot);
  std::vector<Eigen::Vector2d> footholds;
  for (const ContactStance& stance : discrete_.schedule.stances()) {
    footholds.emplace_back(Eigen::Vector2d::Zero());
    if (!stance.lands()) continue;
    terms.update_kinematics(motion.nodes[discrete_.mesh.first_node(stance.first_phase)].q);
    footholds.back() = problem().surfaces[stance.surface].coordinates(terms.contact_position(stance.contact));
  }
  return footholds;
}

void MotionNlp::append(TrajectoryPoint point, Trajectory& motion) {
  const bool jumps = !motion.empty() && point.q.segment<4>(3).dot(motion.nodes.back().q.segment<4>(3)) < 0.0;
  if (jumps) point.q.segment<4>(3) *= -1.0;
  motion.nodes.push_back(std::move(point));
}

}  // namespace prowl
