#include "prowl/trajectory/integration_error.hpp"

#include <boost/math/quadrature/gauss.hpp>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/trajectory/state_scale.hpp"

namespace prowl {
namespace {

/// Rate of the interpolated configuration: base velocity in the world, angular velocity in the base, joint rates.
///
/// With α = s - s²/2h and β = s²/2h, R = R_k exp(α w_k) exp(β w_{k+1}) turns at  exp(-β w_{k+1}) α̇ w_k + β̇ w_{k+1}.
Eigen::VectorXd configuration_rate(const MeshInterval& interval, double s) {
  const auto& [left, right] = interval;
  const double late = s / interval.step();
  const Eigen::Vector3d w_right = right.v.segment<3>(3);

  Eigen::VectorXd rate = (1 - late) * left.v + late * right.v;
  rate.head<3>() =
      (1 - late) * base_rotation(left.q) * left.v.head<3>() + late * base_rotation(right.q) * right.v.head<3>();
  rate.segment<3>(3) = (1 - late) * so3::exp(-0.5 * s * late * w_right) * left.v.segment<3>(3) + late * w_right;
  return rate;
}

/// |ẋ - f(x, τ)| of the interpolated motion at left.time + s.
Eigen::VectorXd residual(const MeshInterval& interval, double s, ConstrainedDynamicsOracle& dynamics) {
  const TrajectoryPoint point = interpolate(interval.left, interval.right, s);
  const Eigen::Index nv = point.v.size();
  Eigen::VectorXd true_rate = point.v;
  true_rate.head<3>() = base_rotation(point.q) * point.v.head<3>();

  Eigen::VectorXd residual(2 * nv);
  residual.head(nv) = configuration_rate(interval, s) - true_rate;
  residual.tail(nv) = point.a - dynamics.evaluate(point.q, point.v, point.tau).a;
  return residual.cwiseAbs();
}

Eigen::VectorXd integrated_residual(const MeshInterval& interval, ConstrainedDynamicsOracle& dynamics) {
  using Gauss = boost::math::quadrature::gauss<double, 5>;  // on [-1, 1]; lists the abscissas >= 0, the first is 0
  const double half = 0.5 * interval.step();
  Eigen::VectorXd sum = Gauss::weights()[0] * residual(interval, half, dynamics);
  for (std::size_t i = 1; i < Gauss::abscissa().size(); ++i) {
    const double offset = half * Gauss::abscissa()[i];
    sum += Gauss::weights()[i] *
           (residual(interval, half - offset, dynamics) + residual(interval, half + offset, dynamics));
  }
  return half * sum;
}

}  // namespace

std::vector<IntervalError> integration_errors(const RobotModel& robot, const Trajectory& trajectory,
                                              PhaseDynamics& dynamics) {
  const Eigen::VectorXd scale = state_scale(trajectory);
  std::vector<IntervalError> errors;
  for (const MeshInterval& interval : mesh_intervals(trajectory)) {
    const Eigen::VectorXd scaled =
        integrated_residual(interval, dynamics[interval.left.phase]).cwiseQuotient(scale);
    Eigen::Index worst = 0;
    const double error = scaled.maxCoeff<Eigen::PropagateNaN>(&worst);
    errors.push_back({interval.left.time, interval.right.time, error, state_name(robot, worst)});
  }
  return errors;
}

}  // namespace prowl
