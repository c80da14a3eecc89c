#include "prowl/trajectory/constrained_dynamics_oracle.hpp"

#include <pinocchio/algorithm/constrained-dynamics.hpp>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/kinematics.hpp>

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {
namespace {

// The proximal iteration contracts by μ / (μ + smallest non-zero eigenvalue of J M⁻¹ J'), which is 1e-4 kg⁻¹ and more:
// three steps. In directions that J does not see rounding is amplified by 1/μ, hence not smaller; there the forces move
// by a little at every step, so that redundant contacts take all of them.
constexpr double kProximalMu = 1e-8;
constexpr double kAccelerationAccuracy = 1e-11;  // [m/s^2]
constexpr double kForceAccuracy = 1e-7;          // [N], between two steps
constexpr int kMaxSteps = 8;

}  // namespace

struct ConstrainedDynamicsOracle::Workspace {
  const PinocchioModel& pinocchio;
  pinocchio::Data data;
  std::vector<int> contacts;
  std::vector<pinocchio::RigidConstraintModel> constraint_models;
  std::vector<pinocchio::RigidConstraintData> constraint_datas;
  Eigen::VectorXd generalized_force;  // S' tau

  Workspace(const PinocchioModel& model, const std::vector<int>& held)
      : pinocchio(model), data(model.model), contacts(held), generalized_force(Eigen::VectorXd::Zero(model.model.nv)) {
    for (int contact : contacts) {
      const pinocchio::Frame& frame = model.model.frames[model.contact_frames[contact]];
      constraint_models.emplace_back(pinocchio::CONTACT_3D, model.model, frame.parentJoint, frame.placement,
                                     pinocchio::LOCAL_WORLD_ALIGNED);
      constraint_datas.emplace_back(constraint_models.back());
    }
    pinocchio::initConstraintDynamics(model.model, data, constraint_models, constraint_datas);
  }

  // By kinematics: in Pinocchio 4.1 settings.absolute_residual leaves out J times the unconstrained acceleration.
  double largest_contact_acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
    pinocchio::forwardKinematics(pinocchio.model, data, q, v, a);
    double largest = 0.0;
    for (int contact : contacts) {
      const auto acceleration = pinocchio::getFrameClassicalAcceleration(
          pinocchio.model, data, pinocchio.contact_frames[contact], pinocchio::LOCAL_WORLD_ALIGNED);
      const double size = acceleration.linear().cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
      if (!(size <= largest)) largest = size;
    }
    return largest;
  }
};

ConstrainedDynamicsOracle::ConstrainedDynamicsOracle(const RobotModel& robot, const std::vector<int>& contacts)
    : workspace_(std::make_unique<Workspace>(robot.pinocchio(), contacts)) {}
ConstrainedDynamicsOracle::ConstrainedDynamicsOracle(ConstrainedDynamicsOracle&&) noexcept = default;
ConstrainedDynamicsOracle::~ConstrainedDynamicsOracle() = default;

ConstrainedDynamicsOracle::Motion ConstrainedDynamicsOracle::evaluate(const Eigen::VectorXd& q,
                                                                      const Eigen::VectorXd& v,
                                                                      const Eigen::VectorXd& tau) {
  Workspace& w = *workspace_;
  w.generalized_force.tail(tau.size()) = tau;
  pinocchio::ProximalSettings settings(kAccelerationAccuracy, kForceAccuracy, kProximalMu, kMaxSteps);

  Motion motion;
// The warning says only that the interface may change in a later version.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
  motion.a = pinocchio::constraintDynamics(w.pinocchio.model, w.data, q, v, w.generalized_force, w.constraint_models,
                                           w.constraint_datas, settings);
#pragma GCC diagnostic pop
  motion.residual = w.largest_contact_acceleration(q, v, motion.a);
  motion.force = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(w.pinocchio.contact_frames.size()));
  for (std::size_t i = 0; i < w.contacts.size(); ++i) {
    motion.force.segment<3>(3 * w.contacts[i]) = w.data.lambda_c.segment<3>(3 * static_cast<Eigen::Index>(i));
  }
  return motion;
}

ConstrainedDynamicsOracle::ContactPoints ConstrainedDynamicsOracle::contact_points(const Eigen::VectorXd& q,
                                                                                   const Eigen::VectorXd& v) {
  Workspace& w = *workspace_;
  const auto& frames = w.pinocchio.contact_frames;
  pinocchio::forwardKinematics(w.pinocchio.model, w.data, q, v);

  ContactPoints points{Eigen::Matrix3Xd(3, frames.size()), Eigen::Matrix3Xd(3, frames.size())};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    points.position.col(column) = pinocchio::updateFramePlacement(w.pinocchio.model, w.data, frames[i]).translation();
    points.velocity.col(column) =
        pinocchio::getFrameVelocity(w.pinocchio.model, w.data, frames[i], pinocchio::LOCAL_WORLD_ALIGNED).linear();
  }
  return points;
}

}  // namespace prowl
