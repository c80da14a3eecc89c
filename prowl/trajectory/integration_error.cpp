#include "prowl/trajectory/integration_error.hpp"

#include <boost/math/quadrature/gauss.hpp>

#include "prowl/trajectory/state_scale.hpp"

namespace prowl {
namespace {

/// |ẋ - f(x, τ)| of the interpolated motion at left.time + s.
Eigen::VectorXd residual(const MeshInterval& interval, double s, ConstrainedDynamicsOracle& dynamics) {
  const TrajectoryPoint point = interpolate(interval.left, interval.right, s);
  const Eigen::Index nv = point.v.size();
  Eigen::VectorXd residual(2 * nv);
  residual.head(nv) = interpolated_rate(interval.left, interval.right, s) - tangent_rate(point);
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
