#include "prowl/certificate/constrained_dynamics_oracle.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <utility>

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {
namespace {

// Smaller pivots of A, over the largest, are rounding. Dependent rows leave 1e-14; the smallest pivot of a real contact
// (light ends of a robot of 80 kg) is 1e-4. Some rows are dependent only in the plane of the motion (knee and foot of
// both hind legs); a plan stays in that plane to its solver's tolerance and leaves 1e-8 to 1e-7.
constexpr double kRankThreshold = 1e-6;
/// Rows with pivots above this, over the largest, are surely independent: A A' then gives ten digits at a fraction of
/// the time of an orthogonal decomposition.
constexpr double kIndependent = 1e-3;

}  // namespace

struct ConstrainedDynamicsOracle::Workspace {
  using Factors = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;

  const PinocchioModel& pinocchio;
  pinocchio::Data data;
  std::vector<int> contacts;
  Eigen::LLT<Eigen::MatrixXd> mass;  // M = L L'
  Eigen::Matrix<double, 6, Eigen::Dynamic> frame_jacobian;
  Eigen::MatrixXd A_transposed;      // L⁻¹ J'
  Eigen::LLT<Eigen::MatrixXd> gram;  // of A A'
  bool is_independent = false;       // rows of A
  Factors factors;                   // of A_transposed, otherwise

  Workspace(const PinocchioModel& model, const std::vector<int>& held)
      : pinocchio(model),
        data(model.model),
        contacts(held),
        frame_jacobian(6, model.model.nv),
        A_transposed(model.model.nv, 3 * static_cast<Eigen::Index>(held.size())) {
    factors.setThreshold(kRankThreshold);
  }

  void factorise(const Eigen::VectorXd& q) {
    // Pinocchio's library contains this instantiation; another takes half a minute to compile. The one in world axes
    // also computes the Jacobian of the joints.
    pinocchio::crba(pinocchio.model, data, Eigen::Ref<const Eigen::VectorXd>(q), pinocchio::Convention::WORLD);
    mass.compute(data.M.selfadjointView<Eigen::Upper>());
    if (contacts.empty()) return;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      frame_jacobian.setZero();
      pinocchio::getFrameJacobian(pinocchio.model, data, pinocchio.contact_frames[contacts[i]],
                                  pinocchio::LOCAL_WORLD_ALIGNED, frame_jacobian);
      A_transposed.middleCols<3>(3 * static_cast<Eigen::Index>(i)) = frame_jacobian.topRows<3>().transpose();
    }
    for (auto column : A_transposed.colwise()) mass.matrixL().solveInPlace(column);
    gram.compute(A_transposed.transpose().lazyProduct(A_transposed));
    const auto pivots = gram.matrixLLT().diagonal();
    is_independent = gram.info() == Eigen::Success && pivots.minCoeff() > kIndependent * pivots.maxCoeff();
    if (!is_independent) factors.compute(A_transposed);
  }

  /// Forces f with A A' f = x, and A' f.
  std::pair<Eigen::VectorXd, Eigen::VectorXd> forces_for(const Eigen::VectorXd& x) const {
    if (is_independent) {
      Eigen::VectorXd force = gram.solve(x), push = A_transposed * force;
      return {std::move(force), std::move(push)};
    }
    Eigen::VectorXd push = factors.transpose().solve(x), force = factors.solve(push);
    return {std::move(force), std::move(push)};
  }

  // J a + J̇v from kinematics, without J.
  Eigen::VectorXd contact_acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
    pinocchio::forwardKinematics(pinocchio.model, data, q, v, a);
    Eigen::VectorXd acceleration(A_transposed.cols());
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      acceleration.segment<3>(3 * static_cast<Eigen::Index>(i)) =
          pinocchio::getFrameClassicalAcceleration(pinocchio.model, data, pinocchio.contact_frames[contacts[i]],
                                                   pinocchio::LOCAL_WORLD_ALIGNED)
              .linear();
    }
    return acceleration;
  }

  /// Rate of v, and forces of the contacts that are held.
  std::pair<Eigen::VectorXd, Eigen::VectorXd> solve(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                                    const Eigen::VectorXd& tau) {
    factorise(q);
    Eigen::VectorXd x = -pinocchio::nonLinearEffects(pinocchio.model, data, q, v);
    x.tail(tau.size()) += tau;
    mass.matrixL().solveInPlace(x);  // b
    Eigen::VectorXd held(A_transposed.cols());
    if (!contacts.empty()) {
      const Eigen::VectorXd drift = contact_acceleration(q, v, Eigen::VectorXd::Zero(v.size()));
      auto [force, push] = forces_for(-drift - A_transposed.transpose() * x);
      x += push;
      held = std::move(force);
    }
    mass.matrixU().solveInPlace(x);
    return {std::move(x), std::move(held)};
  }

  // Forces of all contacts of the robot, zero where not held.
  Eigen::VectorXd of_robot(const Eigen::VectorXd& held_force) const {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(pinocchio.contact_frames.size()));
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      force.segment<3>(3 * contacts[i]) = held_force.segment<3>(3 * static_cast<Eigen::Index>(i));
    }
    return force;
  }
};

ConstrainedDynamicsOracle::ConstrainedDynamicsOracle(const RobotModel& robot, const std::vector<int>& contacts)
    : workspace_(std::make_unique<Workspace>(robot.pinocchio(), contacts)) {}
ConstrainedDynamicsOracle::ConstrainedDynamicsOracle(ConstrainedDynamicsOracle&&) noexcept = default;
ConstrainedDynamicsOracle::~ConstrainedDynamicsOracle() = default;

Eigen::VectorXd ConstrainedDynamicsOracle::acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                                        const Eigen::VectorXd& tau) {
  return workspace_->solve(q, v, tau).first;
}

ConstrainedDynamicsOracle::Motion ConstrainedDynamicsOracle::evaluate(const Eigen::VectorXd& q,
                                                                      const Eigen::VectorXd& v,
                                                                      const Eigen::VectorXd& tau) {
  Workspace& w = *workspace_;
  Motion motion;
  auto [a, force] = w.solve(q, v, tau);
  motion.a = std::move(a);
  motion.force = w.of_robot(force);
  if (!w.contacts.empty()) {
    motion.residual = w.contact_acceleration(q, v, motion.a).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  }
  return motion;
}

Eigen::VectorXd ConstrainedDynamicsOracle::internal_part(const Eigen::VectorXd& force) const {
  const Workspace& w = *workspace_;
  Eigen::VectorXd held(w.A_transposed.cols());
  for (std::size_t i = 0; i < w.contacts.size(); ++i) {
    held.segment<3>(3 * static_cast<Eigen::Index>(i)) = force.segment<3>(3 * w.contacts[i]);
  }
  if (w.contacts.empty() || w.is_independent || w.factors.rank() == held.size())
    return w.of_robot(Eigen::VectorXd::Zero(held.size()));
  return w.of_robot(held - w.factors.solve(w.A_transposed * held));  // A'⁺ A' projects on the forces with an effect
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
