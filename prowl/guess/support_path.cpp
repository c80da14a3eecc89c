#include "prowl/guess/support_path.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "prowl/dynamics/body_bounds.hpp"

namespace prowl {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Part of a support polygon, shrunk about its centre: the margin is for errors of the guess.
constexpr double kInnerPart = 0.8;

/// The point of the convex hull of `corners` that is nearest to p (Frank and Wolfe's method, exact enough for a guess).
Vector2d nearest_in_hull(const std::vector<Vector2d>& corners, const Vector2d& p) {
  constexpr int kSteps = 100;
  Vector2d x = corners.front();
  for (int i = 0; i < kSteps; ++i) {
    const Vector2d away = x - p;
    const auto best = std::ranges::min_element(corners, {}, [&](const Vector2d& c) { return away.dot(c); });
    const Vector2d step = *best - x;
    if (-away.dot(step) <= 1e-12) break;  // no corner is nearer
    x += std::clamp(-away.dot(step) / step.squaredNorm(), 0.0, 1.0) * step;
  }
  return x;
}

bool binds_base(const BoundaryConstraint& constraint) {
  return (constraint.configuration_upper - constraint.configuration_lower).head<2>().maxCoeff() < 1e-3;
}

/// Corners of the inner part of the support polygon.
std::vector<Vector2d> inner_corners(const std::vector<Vector3d>& footholds) {
  std::vector<Vector2d> corners;
  Vector2d centre = Vector2d::Zero();
  for (const Vector3d& foothold : footholds) {
    corners.push_back(foothold.head<2>());
    centre += foothold.head<2>() / static_cast<double>(footholds.size());
  }
  for (Vector2d& corner : corners) corner = centre + kInnerPart * (corner - centre);
  return corners;
}

/// The shift at equally spaced instants.
class ShiftProblem {
 public:
  /// `pendulum`: z / g [s^2].
  ShiftProblem(int size, double step, double pendulum) : size_(size), curvature_(pendulum / (step * step)) {}

  /// Rows of least squares: weight (sum of coefficient times shift) = weight value.
  void add_zero_moment_point(int i) {
    add(i, 1.0, {{i - 1, -curvature_}, {i, 1.0 + 2.0 * curvature_}, {i + 1, -curvature_}});
  }
  void add_effort(int i) { add(-1, kEffort, {{i - 1, -curvature_}, {i, 2.0 * curvature_}, {i + 1, -curvature_}}); }
  void pin(int i) { add(-1, kPin, {{i, 1.0}}); }
  void rest(int i, int j) { add(-1, kPin * curvature_, {{i, 1.0}, {j, -1.0}}); }

  void factorise() {
    rows_.resize(static_cast<Eigen::Index>(instants_.size()), size_);
    rows_.setFromTriplets(triplets_.begin(), triplets_.end());
    solver_.compute(Eigen::SparseMatrix<double>(rows_.transpose() * rows_));
  }
  /// Shifts for zero moment points that should move by `wanted` (columns x y, one row per instant) [m].
  Eigen::MatrixX2d solve(const Eigen::MatrixX2d& wanted) const {
    Eigen::MatrixX2d values = Eigen::MatrixX2d::Zero(rows_.rows(), 2);
    for (Eigen::Index row = 0; row < values.rows(); ++row) {
      const int i = instants_[row];
      if (i >= 0) values.row(row) = wanted.row(i);
    }
    return solver_.solve(rows_.transpose() * values);
  }
  /// Motion of the zero moment point by shifts.
  Eigen::MatrixX2d zero_moment_shift(const Eigen::MatrixX2d& shift) const {
    Eigen::MatrixX2d moved = shift;
    for (int i = 1; i + 1 < size_; ++i) {
      moved.row(i) -= curvature_ * (shift.row(i - 1) - 2.0 * shift.row(i) + shift.row(i + 1));
    }
    return moved;
  }

 private:
  static constexpr double kEffort = 0.1;  // weight of the acceleration, as a distance of the zero moment point
  static constexpr double kPin = 1e3;     // large enough to act as a condition

  void add(int instant, double weight, std::initializer_list<std::pair<int, double>> row) {
    for (const auto& [column, value] : row)
      triplets_.emplace_back(static_cast<int>(instants_.size()), column, weight * value);
    instants_.push_back(instant);
  }

  int size_;
  double curvature_;
  std::vector<int> instants_;  ///< of each row, -1 if it aims for zero
  std::vector<Eigen::Triplet<double>> triplets_;
  Eigen::SparseMatrix<double> rows_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace

SupportPath::SupportPath(const DiscreteProblem& discrete, const PosturePath& posture, const ContactPath& contacts) {
  constexpr double kStep = 0.02;  // [s]; short against the time in which a robot topples
  constexpr int kLeast = 20, kMost = 5000, kRounds = 30;
  const MotionProblem& problem = discrete.problem;
  const double duration = discrete.nodes.back().time;
  const int last = std::clamp(static_cast<int>(std::ceil(duration / kStep)), kLeast, kMost);
  const double step = duration / last;
  const double pendulum = problem.robot.nominal_configuration()(2) / RobotModel::kGravity;

  std::vector<std::vector<Vector2d>> polygons;
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p)
    polygons.push_back(inner_corners(contacts.held_footholds(p)));
  ShiftProblem shifts(last + 1, step, pendulum);
  Eigen::MatrixX2d com(last + 1, 2);
  const VectorXd rest = VectorXd::Zero(problem.robot.nv());
  std::vector<int> phase_at;
  std::size_t node = 0;
  for (int i = 0; i <= last; ++i) {
    while (node + 1 < discrete.nodes.size() && discrete.nodes[node + 1].time <= i * step) ++node;
    phase_at.push_back(discrete.nodes[node].phase);
    const VectorXd q = posture(i * step);
    com.row(i) = centre_of_mass(problem.robot, q, rest).position.head<2>().transpose();
    if (i == 0 || i == last) continue;
    if (!polygons[phase_at.back()].empty()) shifts.add_zero_moment_point(i);
    shifts.add_effort(i);
  }
  shifts.rest(0, 1);
  shifts.rest(last, last - 1);
  for (std::size_t c = 0; c < problem.boundary_constraints.size(); ++c) {
    if (!binds_base(problem.boundary_constraints[c])) continue;
    shifts.pin(static_cast<int>(std::lround(discrete.boundary_time(c) / step)));
  }
  shifts.factorise();

  Eigen::MatrixX2d nominal = com;  // zero moment point without a shift
  for (int i = 1; i < last; ++i) {
    nominal.row(i) -= pendulum / (step * step) * (com.row(i - 1) - 2.0 * com.row(i) + com.row(i + 1));
  }
  Eigen::MatrixX2d shift = Eigen::MatrixX2d::Zero(last + 1, 2);
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::MatrixX2d zmp = nominal + shifts.zero_moment_shift(shift);
    Eigen::MatrixX2d wanted = Eigen::MatrixX2d::Zero(last + 1, 2);
    for (int i = 1; i < last; ++i) {
      const auto& polygon = polygons[phase_at[i]];
      if (!polygon.empty())
        wanted.row(i) = nearest_in_hull(polygon, zmp.row(i).transpose()).transpose() - nominal.row(i);
    }
    shift = shifts.solve(wanted);
  }
  for (const int axis : {0, 1}) {
    std::vector<Waypoint> waypoints;
    for (int i = 0; i <= last; ++i) {
      const int before = std::max(i - 1, 0), after = std::min(i + 1, last);
      waypoints.push_back(
          {i * step, shift(i, axis), (shift(after, axis) - shift(before, axis)) / ((after - before) * step)});
    }
    curves_.emplace_back(waypoints);
  }
}

Vector2d SupportPath::operator()(double time) const { return {curves_[0](time), curves_[1](time)}; }

}  // namespace prowl
