#include "prowl/dynamics/inverse_kinematics.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"

namespace prowl {

namespace {

using BoolArray = Eigen::Array<bool, Eigen::Dynamic, 1>;

constexpr int kMaxIterations = 200;
constexpr double kFirstDamping = 1e-6;  // [m²]: far below the square of a leg's length, so nearly Gauss-Newton
constexpr double kLeastDamping = 1e-14;
constexpr double kMostDamping = 1e6;  // no descent along the projected gradient: a minimum to rounding
constexpr double kLeastStep = 1e-12;  // [rad]

std::vector<int> contacts_of(const std::vector<ContactTarget>& targets) {
  std::vector<int> contacts;
  for (const ContactTarget& target : targets) contacts.push_back(target.contact);
  return contacts;
}

/// Distances of the contacts from their targets as a function of the joints, at one pose of the base.
class Misfit {
 public:
  Misfit(const RobotModel& robot, const std::vector<ContactTarget>& targets)
      : terms_(robot), kinematics_(contacts_of(targets)), targets_(kinematics_.rows()) {
    for (std::size_t c = 0; c < targets.size(); ++c) {
      targets_.segment<3>(3 * static_cast<Eigen::Index>(c)) = targets[c].position;
    }
  }

  Eigen::VectorXd operator()(const Eigen::VectorXd& q) {
    terms_.update_kinematics(q);
    kinematics_.set_configuration(terms_);
    return kinematics_.positions() - targets_;
  }
  /// d(misfit)/d(joints) at the q of the last evaluation.
  Eigen::MatrixXd jacobian() const { return kinematics_.jacobian().rightCols(terms_.nv() - 6); }

 private:
  RigidBodyTerms terms_;
  ContactKinematics kinematics_;
  Eigen::VectorXd targets_;
};

/// Levenberg-Marquardt step of the joints that are not held at a limit.
Eigen::VectorXd damped_step(const Eigen::MatrixXd& J, const Eigen::VectorXd& gradient, const BoolArray& held,
                            double damping) {
  const Eigen::VectorXd free = (!held).cast<double>();
  const Eigen::MatrixXd J_free = J * free.asDiagonal();
  Eigen::MatrixXd normal = J_free.transpose() * J_free;
  normal.diagonal().array() += damping;
  return normal.ldlt().solve(-gradient.cwiseProduct(free)).cwiseProduct(free);
}

double largest_distance(const Eigen::VectorXd& misfit) {
  return misfit.size() == 0 ? 0.0 : misfit.reshaped(3, misfit.size() / 3).colwise().norm().maxCoeff();
}

}  // namespace

InverseKinematics inverse_kinematics(const RobotModel& robot, const Eigen::VectorXd& q_guess,
                                     const std::vector<ContactTarget>& targets) {
  const Eigen::VectorXd& lower = robot.position_lower();
  const Eigen::VectorXd& upper = robot.position_upper();
  const auto joints = [&](Eigen::VectorXd& q) { return q.tail(robot.nu()); };

  Misfit misfit(robot, targets);
  InverseKinematics result;
  Eigen::VectorXd& q = result.q;
  q = q_guess;
  joints(q) = joints(q).cwiseMax(lower).cwiseMin(upper).eval();
  Eigen::VectorXd error = misfit(q);
  Eigen::MatrixXd J = misfit.jacobian();

  double damping = kFirstDamping;
  for (int i = 0; i < kMaxIterations && largest_distance(error) > InverseKinematics::kTolerance; ++i) {
    const Eigen::VectorXd gradient = J.transpose() * error;
    // A joint at a limit that the gradient pushes against stays there.
    const BoolArray held = (joints(q).array() <= lower.array() && gradient.array() > 0.0) ||
                           (joints(q).array() >= upper.array() && gradient.array() < 0.0);
    Eigen::VectorXd trial = q;
    joints(trial) = (joints(q) + damped_step(J, gradient, held, damping)).cwiseMax(lower).cwiseMin(upper);
    if ((trial - q).lpNorm<Eigen::Infinity>() < kLeastStep) break;

    const Eigen::VectorXd trial_error = misfit(trial);
    if (trial_error.squaredNorm() < error.squaredNorm()) {
      q = trial;
      error = trial_error;
      J = misfit.jacobian();
      damping = std::max(kLeastDamping, 0.1 * damping);
    } else {
      damping *= 10.0;
      if (damping > kMostDamping) break;
    }
  }
  result.residual = largest_distance(error);
  result.converged = result.residual <= InverseKinematics::kTolerance;
  return result;
}

}  // namespace prowl
