#include "prowl/mpc/state_prediction.hpp"

#include <algorithm>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/mpc/standing_robot.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

constexpr double kPredictionStep = 2e-3;  ///< [s]

}  // namespace

StatePrediction::StatePrediction(const RobotModel& robot, const std::vector<std::vector<int>>& feet)
    : robot_(robot), a_(VectorXd::Zero(robot.nv())), tau_(VectorXd::Zero(robot.nu())), v_middle_(a_) {
  for (unsigned bits = 0; bits < 1U << feet.size(); ++bits) {
    dynamics_.push_back(std::make_unique<ForwardDynamics>(robot, standing_contacts(feet, bits), kContactRankThreshold));
    dynamics_.back()->evaluate(robot.nominal_configuration(), a_, tau_);  // sizes its work space
  }
}

void StatePrediction::predict(const LatestPlans& plans, const ContactTimeline& timeline, double from, double to,
                              VectorXd& q, VectorXd& v) {
  while (to - from > kTimeRounding) {
    const double dt = std::min(kPredictionStep, to - from);
    plans.torque(from, q, v, tau_);
    ForwardDynamics& dynamics = *dynamics_[timeline.standing(from + 0.5 * dt)];
    try {
      dynamics.evaluate(q, v, tau_);
      a_ = dynamics.acceleration();
    } catch (const NumericalError&) {
      a_.setZero();
    }
    v_middle_ = v + 0.5 * dt * a_;
    const Eigen::Matrix3d rotation = base_rotation(q);
    q.head<3>() += dt * (rotation * v_middle_.head<3>());
    set_base_rotation(q, rotation * so3::exp(dt * v_middle_.segment<3>(3)));
    q.tail(robot_.nu()) += dt * v_middle_.tail(robot_.nu());
    v += dt * a_;
    from += dt;
  }
}

}  // namespace prowl
