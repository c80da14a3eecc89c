#include "prowl/mpc/command_lead.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "prowl/model/configuration.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// Largest distance of the reference pose from the robot: a share of its size, and [rad].
constexpr double kMostOff = 0.1, kMostTurnOff = 0.15;
/// Largest commands: speed over sqrt(g height), and turn times sqrt(height / g); and the largest changes of both a
/// second, over g, and times height / g.
constexpr double kMostSpeed = 0.45, kMostTurn = 0.25, kMostPush = 0.15, kMostSpin = 0.2;
constexpr double kLongestPeriod = 0.2;  ///< after a longer pause it does not lead far away at once [s]
constexpr double kMostHeight = 0.15;    ///< of the standing height, up and down

double wrapped(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

}  // namespace

CommandLead::CommandLead(const VectorXd& standing, const VectorXd& q, double t)
    : standing_(standing), led_until_(t), place_(q.head<2>()), heading_(heading(q)) {}

MpcCommand CommandLead::command(const MpcCommand& command) {
  asked_ = command;
  const double height = standing_.z(), time = std::sqrt(height / RobotModel::kGravity);
  const double fastest = stands_ ? 0.0 : kMostSpeed * RobotModel::kGravity * time;
  const double turn = stands_ ? 0.0 : kMostTurn / time;
  const auto within = [](double value, double most) {
    return std::isfinite(value) ? std::clamp(value, -most, most) : 0.0;
  };
  command_ = {within(command.forward, fastest), within(command.left, 0.5 * fastest), within(command.turn, turn),
              within(command.height, kMostHeight * height)};
  return command_;
}

void CommandLead::stand(bool stands) {
  stands_ = stands;
  command(asked_);
}

void CommandLead::advance(double start) {
  const double cos = std::cos(heading_), sin = std::sin(heading_);
  const double dt = std::clamp(start - led_until_, 0.0, kLongestPeriod);
  led_until_ = start;
  const auto approach = [](double& value, double target, double most) {
    value += std::clamp(target - value, -most, most);
  };
  approach(smooth_.forward, command_.forward, dt * kMostPush * RobotModel::kGravity);
  approach(smooth_.left, command_.left, dt * kMostPush * RobotModel::kGravity);
  approach(smooth_.turn, command_.turn, dt * kMostSpin * RobotModel::kGravity / standing_.z());
  approach(smooth_.height, command_.height, dt * kMostHeight * standing_.z());
  const auto [forward, left, turn, raised] = smooth_;
  place_ += dt * Eigen::Vector2d(cos * forward - sin * left, sin * forward + cos * left);
  heading_ = wrapped(heading_ + dt * turn);
}

void CommandLead::lead(double start, const HorizonGrid& grid, const GroundPlane& ground, HorizonProgram& program) {
  advance(start);
  const auto [forward, left, turn, raised] = smooth_;
  for (int k = 0; k < program.num_stages(); ++k) {
    HorizonStep& step = program.step(k);
    const double ahead = grid.middle(k) - start, turned = heading_ + ahead * turn;
    const double middle = heading_ + 0.5 * ahead * turn, c = std::cos(middle), s = std::sin(middle);
    step.q_ref = standing_;
    const Eigen::Vector2d place = place_ + ahead * Eigen::Vector2d(c * forward - s * left, s * forward + c * left);
    step.q_ref.head<3>() << place, ground.height(place) + standing_.z() + raised;
    // The base stays parallel to the ground: the joints are as on level ground.
    set_base_rotation(step.q_ref, Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ground.normal()) *
                                      Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ()).toRotationMatrix());
    step.v_ref.setZero();
    step.v_ref.head<2>() << forward, left;
    step.v_ref(5) = turn;
  }
}

void CommandLead::stay_near(const VectorXd& q, double size) {
  const double most = kMostOff * size;
  const Eigen::Vector2d off = place_ - q.head<2>();
  if (off.norm() > most) place_ = q.head<2>() + off * (most / off.norm());
  const double turned = wrapped(heading_ - heading(q));
  heading_ = heading(q) + std::clamp(turned, -kMostTurnOff, kMostTurnOff);
}

}  // namespace prowl
