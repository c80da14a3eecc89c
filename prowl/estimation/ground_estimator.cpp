#include "prowl/estimation/ground_estimator.hpp"

#include <algorithm>

#include "prowl/linear_algebra/factorisations.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {
namespace {

// Lengths are shares of the standing height of the base; 0.01 of HyQ's is 6 mm.
constexpr double kHeight = 0.02;    // expected at the start
constexpr double kTilt = 0.03;      // expected at the start [rad]
constexpr double kWander = 0.01;    // of the height [1/sqrt(s)]: the estimated position of the base drifts
constexpr double kBend = 0.01;      // of the tilt [rad/sqrt(s)]: the ground ahead is not that behind
constexpr double kFoothold = 0.01;  // of each foothold by itself
constexpr double kSame = 0.1;       // [s]: samples of a foot within it are one measurement
constexpr double kSettling = 0.05;  // [s] after a planned landing
// A foot that hovers over the ground when it should carry the robot is driven away by the torques for its load, 6 cm in
// 40 ms. Hence feet aim a little below the ground from before they land [s] until they carry load.
constexpr double kPress = 0.01;
constexpr double kRelease = 0.1;  // [s] from full to none

}  // namespace

GroundEstimator::GroundEstimator(const RobotModel& robot, const Eigen::VectorXd& q_start, const Stand& stand,
                                 std::vector<bool> footed)
    : legs_(robot),
      footed_(std::move(footed)),
      since_(footed_.size(), -1.0),
      planned_(footed_.size()),
      press_(footed_.size(), 0.0),
      normals_(stand.normals),
      size_(robot.nominal_configuration().z()),
      pivot_(base_position(q_start) - size_ * Eigen::Vector3d::UnitZ()) {
  for (std::size_t c = 0; c < since_.size(); ++c) {
    if (stand.in_contact[c]) since_[c] = kSettling;
  }
  covariance_.diagonal() << kHeight * kHeight * size_ * size_, kTilt * kTilt, kTilt * kTilt;
}

void GroundEstimator::update(double dt, const Eigen::VectorXd& q, const Eigen::VectorXd& q_planned, const Stand& stand,
                             const Stand& soon) {
  legs_.update(q_planned.tail(q_planned.size() - 7));
  for (std::size_t c = 0; c < planned_.size(); ++c)
    planned_[c] = base_position(q_planned) + base_rotation(q_planned) * legs_.position(static_cast<int>(c));

  covariance_.diagonal() += dt * Eigen::Vector3d(kWander * kWander * size_ * size_, kBend * kBend, kBend * kBend);
  legs_.update(q.tail(q.size() - 7));
  const double variance = kFoothold * kFoothold * size_ * size_ * kSame / dt;
  for (std::size_t c = 0; c < since_.size(); ++c) {
    since_[c] = stand.in_contact[c] ? std::max(since_[c], 0.0) + dt : -1.0;
    const bool lands = stand.in_contact[c] ? since_[c] < kSettling : soon.in_contact[c];
    press_[c] = std::clamp(press_[c] + dt * (lands ? 1.0 / kLead : -1.0 / kRelease), 0.0, 1.0);
    if (lands) normals_[c] = stand.in_contact[c] ? stand.normals[c] : soon.normals[c];
    if (since_[c] < kSettling) continue;
    const Eigen::Vector3d foot = base_position(q) + base_rotation(q) * legs_.position(static_cast<int>(c));
    const Eigen::Vector3d& normal = stand.normals[c];
    const Eigen::Vector3d lever = (planned_[c] - pivot_).cross(normal);
    const Eigen::Vector3d row(normal.z(), lever.x(), lever.y());
    const Eigen::Vector3d spread = covariance_ * row;
    const Eigen::Vector3d gain = spread / (row.dot(spread) + variance);
    state_ += gain * (normal.dot(foot - planned_[c]) - row.dot(state_));
    covariance_ -= gain * spread.transpose();
  }
}

Eigen::Vector3d GroundEstimator::displacement(const Eigen::Vector3d& p) const {
  return state_(0) * Eigen::Vector3d::UnitZ() + Eigen::Vector3d(state_(1), state_(2), 0.0).cross(p - pivot_);
}

Eigen::VectorXd GroundEstimator::correction(const Eigen::VectorXd& q_planned) {
  const Eigen::Index nu = q_planned.size() - 7;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(6 + nu);
  const Eigen::Vector3d base = base_position(q_planned);
  legs_.update(q_planned.tail(nu));
  const Eigen::Matrix3d R = base_rotation(q_planned);
  const auto rows = 3 * static_cast<Eigen::Index>(footed_.size());
  Eigen::MatrixXd by_joints = Eigen::MatrixXd::Zero(rows, nu);
  Eigen::VectorXd ways = Eigen::VectorXd::Zero(rows);
  for (std::size_t c = 0; c < footed_.size(); ++c) {
    if (!footed_[c]) continue;
    const int contact = static_cast<int>(c);
    const Eigen::Vector3d way =
        displacement(base + R * legs_.position(contact)) - press_[c] * kPress * size_ * normals_[c];
    by_joints.middleRows<3>(3 * contact) = legs_.linear(contact);
    ways.segment<3>(3 * contact) = R.transpose() * way;
  }
  step.tail(nu) = damped_solution(by_joints, ways);
  return step;
}

}  // namespace prowl
