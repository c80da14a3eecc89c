#include "prowl/mpc/horizon_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "prowl/model/configuration.hpp"

namespace prowl {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A foot is at most this fast when it lands [m/s], and before that as fast as it can brake with this [m/s^2].
constexpr double kLandingSpeed = 0.1, kLandingBrake = 30.0;
/// Until its landing is felt, a foot carries at most this share of the weight, plus this share a second since it should
/// have landed. More would throw a leg at the ground that comes a few milliseconds late: it bounces.
constexpr double kLandingLoad = 0.15, kLoadRate = 15.0;
constexpr double kFrictionPrice = 10.0;  ///< of friction in later steps, times the price of others: it hardly gives way
/// A foot lands so far below the ground [m], within kOnGround, and searches it this fast if it does not find it [m/s].
constexpr double kPress = 4e-3, kOnGround = 4e-3, kSearch = 0.3;
/// The height at a landing counts as that of a swing for so long at least [s], a long step of a horizon: a landing is
/// bound in one step, however short that is. If it is cheaper, plans land feet above the ground: then Go2 falls.
constexpr double kLandingPriceTime = 0.05;

}  // namespace

HorizonBounds::HorizonBounds(const HorizonProgram& program, const MpcOptions& options)
    : program_(program), options_(options), q_(program.standing_posture()), v_(program.robot().nv()) {
  RigidBodyTerms terms(program.robot());
  terms.update_kinematics(q_);
  for (const std::vector<int>& foot : program.feet())
    offsets_.emplace_back(terms.contact_position(foot.front()).head<2>() - q_.head<2>());
}

void HorizonBounds::set(const HorizonGrid& grid, const ContactTimeline& timeline, const GroundPlane& ground,
                        HorizonSolver& solver) {
  const double length = program_.length_unit();
  const double speed = program_.row_unit(program_.contact_velocity_row(0));
  const double force = program_.row_unit(program_.friction_row(0));
  for (int k = 0; k < program_.num_stages(); ++k) {
    BarrierRows& rows = solver.rows(k);
    const HorizonStep& step = program_.step(k);
    const double price = options_.weights.penalty * step.length;
    const double friction_price = k < kSoftSteps ? price : kFrictionPrice * price;
    program_.get_state(k, q_, v_);
    const double turned = heading(q_), cos = std::cos(turned), sin = std::sin(turned);
    for (int f = 0; f < program_.num_feet(); ++f) {
      const bool stands = ((step.standing >> f) & 1U) != 0;
      const FootBounds foot = bounds_of(f, k, ground.height(place_of(f, cos, sin)), grid, timeline);
      for (const int contact : program_.feet()[static_cast<std::size_t>(f)]) {
        for (int i = 0; i < FrictionLimit::kMostRows; ++i)
          rows.set_bounds(program_.friction_row(contact) + i, stands ? 0.0 : -kInfinity, foot.most_friction / force,
                          friction_price);
        rows.set_bounds(program_.height_row(contact), foot.least / length, foot.most / length,
                        options_.weights.penalty * foot.price_time);
        for (int axis = 0; axis < 3; ++axis)
          rows.set_bounds(program_.contact_velocity_row(contact) + axis, -foot.fastest / speed, foot.fastest / speed,
                          price);
      }
    }
    set_limits(rows, price);
  }
}

/// Where a foot of the standing posture is, if the base is at q_ [m].
Eigen::Vector2d HorizonBounds::place_of(int foot, double cos, double sin) const {
  const Eigen::Vector2d& off = offsets_[static_cast<std::size_t>(foot)];
  return q_.head<2>() + Eigen::Vector2d(cos * off.x() - sin * off.y(), sin * off.x() + cos * off.y());
}

HorizonBounds::FootBounds HorizonBounds::bounds_of(int foot, int k, double ground, const HorizonGrid& grid,
                                                   const ContactTimeline& timeline) const {
  const double t = grid.middle(k);
  const auto stands_in = [&](int step) { return ((program_.step(step).standing >> foot) & 1U) != 0; };
  FootBounds bounds{-kInfinity, kInfinity, kInfinity, stands_in(k) ? most_friction(foot, t, timeline) : kInfinity,
                    grid.step(k)};
  if (const ContactTimeline::Swing* const swing = timeline.swing(foot, t)) {
    const double s = (t - swing->lift) / (swing->land - swing->lift), left = swing->land - t;
    bounds.least = ground + options_.clearance * program_.standing_posture().z() * swing_profile(s);
    bounds.fastest = kLandingSpeed + kLandingBrake * left;
    if (s > 0.5) {
      bounds.least -= kPress * s;
      bounds.most = ground + (kLandingSpeed + 0.5 * kLandingBrake * left) * left;  // from where it can brake
    }
  } else if (k > 0 && !stands_in(k - 1)) {  // lands at the start of this step
    bounds.most = ground - (kPress + kSearch * timeline.lateness(foot, grid.time(k), grid.time(0)));
    bounds.least = bounds.most - kOnGround;
    bounds.price_time = std::max(grid.step(k), kLandingPriceTime);
  }
  return bounds;
}

/// Keeps the normal force of a foot that has not been felt yet below what it may carry: two opposite friction rows add
/// up to sqrt(2) times friction times that force.
double HorizonBounds::most_friction(int foot, double t, const ContactTimeline& timeline) const {
  const ContactTimeline::Swing* const unfelt = timeline.unfelt(foot, t);
  if (!unfelt) return kInfinity;
  const double load = program_.robot().weight() * (kLandingLoad + kLoadRate * (t - unfelt->land));
  const auto contacts = static_cast<double>(program_.feet()[static_cast<std::size_t>(foot)].size());
  return options_.friction / std::numbers::sqrt2 * load / contacts;
}

void HorizonBounds::set_limits(BarrierRows& rows, double price) const {
  const RobotModel& robot = program_.robot();
  for (int i = 0; i < program_.num_curve_rows(); ++i)
    rows.set_bounds(program_.curve_row() + i, 0.0, kInfinity, BarrierRows::kHard);
  for (int j = 0; j < robot.nu(); ++j) {
    const double position = program_.row_unit(program_.position_row(j));
    const double velocity = robot.velocity_limit()(j) / program_.row_unit(program_.velocity_row(j));
    const double torque = robot.torque_limit()(j) / program_.row_unit(program_.torque_row(j));
    rows.set_bounds(program_.position_row(j), robot.position_lower()(j) / position,
                    robot.position_upper()(j) / position, price);
    rows.set_bounds(program_.velocity_row(j), -velocity, velocity, price);
    rows.set_bounds(program_.torque_row(j), -torque, torque, BarrierRows::kHard);
  }
}

}  // namespace prowl
