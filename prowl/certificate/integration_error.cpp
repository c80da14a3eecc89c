#include "prowl/certificate/integration_error.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <deque>
#include <utility>

#include "prowl/certificate/worst_case.hpp"
#include "prowl/trajectory/state_scale.hpp"

namespace prowl {
namespace {

/// |ẋ - f(x, τ)| of the interpolated motion at left.time + s.
Eigen::VectorXd residual(const MeshInterval& interval, double s, ConstrainedDynamicsOracle& dynamics) {
  const TrajectoryPoint point = interval.at(s);
  const Eigen::Index nv = point.v.size();
  Eigen::VectorXd residual(2 * nv);
  residual.head(nv) = interval.rate(s) - tangent_rate(point);
  residual.tail(nv) = point.a - dynamics.acceleration(point.q, point.v, point.tau);
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

/// Sum of the errors of the intervals in the last second, at least of one interval.
class LastSecond {
 public:
  explicit LastSecond(Eigen::Index size) : sum_(Eigen::VectorXd::Zero(size)) {}

  const Eigen::VectorXd& add(double start, double end, Eigen::VectorXd errors) {
    constexpr double kRounding = 1e-9;  // [s]
    while (!intervals_.empty() && intervals_.front().start < end - 1.0 - kRounding) {
      sum_ -= intervals_.front().errors;
      intervals_.pop_front();
    }
    sum_ += errors;
    intervals_.push_back({start, std::move(errors)});
    return sum_;
  }

 private:
  struct Interval {
    double start;
    Eigen::VectorXd errors;
  };
  std::deque<Interval> intervals_;
  Eigen::VectorXd sum_;
};

}  // namespace

IntegrationErrors integration_errors(const RobotModel& robot, const Trajectory& trajectory, PhaseDynamics& dynamics) {
  using Limits = CertificateLimits;
  WorstCase local("local integration error", "-", Limits::integration_error_draft, Limits::integration_error_certified);
  WorstCase second("integration error in a second", "-", Limits::second_error_draft, Limits::second_error_certified);
  const Eigen::VectorXd scale = state_scale(trajectory);
  LastSecond last_second(scale.size());
  IntegrationErrors result;
  for (const MeshInterval& interval : mesh_intervals(trajectory)) {
    const double start = interval.left.time, end = interval.right.time;
    const Eigen::VectorXd errors = integrated_residual(interval, dynamics[interval.left.phase]).cwiseQuotient(scale);
    Eigen::Index i = 0;
    const double largest = errors.maxCoeff<Eigen::PropagateNaN>(&i);
    result.intervals.push_back({start, end, largest, state_name(robot, i)});
    local.record(largest, start, state_name(robot, i));
    const double in_a_second = last_second.add(start, end, errors).maxCoeff<Eigen::PropagateNaN>(&i);
    second.record(in_a_second, end, state_name(robot, i));
  }
  result.checks = {local.check(), second.check()};
  return result;
}

}  // namespace prowl
