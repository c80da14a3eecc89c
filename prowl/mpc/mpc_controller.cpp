#include "prowl/mpc/mpc_controller.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Velocities of contacts that stand decay with these time constants at least [s]. In the first steps slowly, as what
/// is measured of them is mostly noise. Later at once in effect: slower decay holds more kicks, but lets feet creep.
constexpr double kContactTime = 0.05, kLaterContactTime = 0.02;
/// A foot is at most this fast when it lands [m/s], and before that as fast as it can brake with this [m/s^2].
constexpr double kLandingSpeed = 0.1, kLandingBrake = 30.0;
/// Until its landing is felt, a foot carries at most this share of the weight, plus this share a second since it should
/// have landed, for so long [s]. More would throw a leg at the ground that comes a few milliseconds late: it bounces.
constexpr double kLandingLoad = 0.15, kLoadRate = 15.0, kLandingTime = 0.05;
constexpr int kSoftSteps = 2;            ///< whose friction gives way as other limits do
constexpr double kFrictionPrice = 10.0;  ///< of friction in later steps, times the price of others: it hardly gives way
constexpr int kMostFailures = 5;         ///< in a row, before an update starts anew
constexpr double kSettledShare = 0.5;    ///< of a step; with less, the next update starts anew
/// A foot lands so far below the ground [m], within kOnGround, and searches it this fast if it does not find it [m/s].
constexpr double kPress = 4e-3, kOnGround = 4e-3, kSearch = 0.3;
/// The place to which the command has led stays this near to the robot: a share of its size, and [rad].
constexpr double kLeash = 0.1, kTurnLeash = 0.15;
/// A foot that has not landed when a plan is made does not carry at the start of that plan, for so long [s].
constexpr double kSoon = 5e-3;
constexpr double kPredictionStep = 2e-3;  ///< [s]
constexpr double kGroundTime = 0.1;       ///< filter of height and slope of the ground [s]
constexpr int kFirstIterations = 30;      ///< of the plan with which a controller begins
/// Largest commands: speed over sqrt(g height), and turn times sqrt(height / g); and the largest changes of both a
/// second, over g, and times height / g.
constexpr double kMostSpeed = 0.45, kMostTurn = 0.25, kMostPush = 0.15, kMostSpin = 0.2;
constexpr double kMostHeight = 0.15;  ///< of the standing height, up and down

double yaw(const VectorXd& q) { return rpy_from_rotation(base_rotation(q)).z(); }

double wrapped(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

}  // namespace

MpcController::MpcController(const RobotModel& robot, const MpcOptions& options, const VectorXd& q, const VectorXd& v,
                             double t)
    : robot_(robot),
      options_(options),
      program_(robot, options.weights, options.friction, options.steps),
      solver_(program_, options.barrier, options.iterations),
      timeline_(program_.num_feet(), t),
      grid_(options.steps, options.first_step, options.least_horizon),
      plan_(robot_, options.steps),
      previous_(robot_, options.steps),
      terms_(robot_),
      ground_(static_cast<int>(robot.contacts().size()), robot.size()),
      led_until_(t),
      place_(q.head<2>()),
      heading_(yaw(q)) {
  for (unsigned bits = 0; bits < program_.num_sets(); ++bits) {
    dynamics_.push_back(std::make_unique<ForwardDynamics>(robot_, program_.contacts(bits), kContactRankThreshold));
    dynamics_.back()->evaluate(q, VectorXd::Zero(robot.nv()), VectorXd::Zero(robot.nu()));  // sizes its work space
  }
  terms_.update_kinematics(program_.standing_posture());
  for (const std::vector<int>& foot : program_.feet())
    offsets_.emplace_back(terms_.contact_position(foot.front()).head<2>() - program_.standing_posture().head<2>());
  const StaticEquilibrium still = static_equilibrium(robot_, q, program_.contacts(standing_at(t)));
  q_ = q_next_ = q;
  v_ = v_next_ = VectorXd::Zero(robot.nv());
  a_ = v_;
  tau_ = still.tau;
  grid_.lay(t, timeline_);
  for (int k = 0; k < options.steps; ++k) {
    MpcPlan::Step& step = plan_.steps()[static_cast<std::size_t>(k)];
    step = {grid_.time(k), grid_.step(k), standing_at(t), q, v_, a_, still.tau, still.force, step.gain};
    old_rows_.push_back(solver_.rows(k));
    old_multipliers_.push_back(program_.multipliers(k));
    old_lengths_.push_back(grid_.step(k));
  }
  program_.use_hessian(options.hessian);
  find_ground(q, t);
  bool solved = false;
  for (int i = 0; i < kFirstIterations; ++i) solved = prepare(t) && plan(q, v, t);
  if (!solved) throw InputError(robot.name() + ": no plan holds the robot in its standing posture");
  counters_ = {};
}

void MpcController::follow(const SteppingPattern& pattern) {
  timeline_.follow(pattern);
  grid_ = HorizonGrid(options_.steps, options_.first_step, std::max(options_.least_horizon, pattern.stride));
}

unsigned MpcController::standing_at(double t) const {
  unsigned bits = 0;
  for (int f = 0; f < program_.num_feet(); ++f) {
    if (!timeline_.swing(f, t)) bits |= 1U << f;
  }
  return bits;
}

void MpcController::feel_contacts(const std::vector<bool>& touches, double t) {
  const double soon = options_.delay + kSoon;
  for (int f = 0; f < program_.num_feet(); ++f) timeline_.feel(f, touches[static_cast<std::size_t>(f)], t, soon);
}

MpcCommand MpcController::command(const MpcCommand& command) {
  const double height = program_.standing_posture().z(), time = std::sqrt(height / RobotModel::kGravity);
  const double fastest = kMostSpeed * RobotModel::kGravity * time, turn = kMostTurn / time;
  const auto within = [](double value, double most) {
    return std::isfinite(value) ? std::clamp(value, -most, most) : 0.0;
  };
  command_ = {within(command.forward, fastest), within(command.left, 0.5 * fastest), within(command.turn, turn),
              within(command.height, kMostHeight * height)};
  return command_;
}

void MpcController::drop_latest() { std::swap(plan_.steps(), previous_.steps()); }

bool MpcController::update(const VectorXd& q, const VectorXd& v, double t) { return prepare(t) && plan(q, v, t); }

bool MpcController::prepare(double t) {
  ++counters_.updates;
  if (!is_settled_) restart();
  lay_horizon(t + options_.delay);
  shift();
  lead(t + options_.delay);
  set_bounds();
  const bool is_ready = is_settled_ = solver_.prepare();
  if (!is_ready) ++counters_.failed;
  if (solver_.regularisation() > 0.0) ++counters_.regularised;
  return is_ready;
}

void MpcController::lay_horizon(double start) {
  timeline_.extend(start, start + grid_.length() + 0.1);
  grid_.lay(start, timeline_);
  horizon_start_ = start;
}

/// Puts the last plan on the new steps: its states, and the means of its accelerations and torques, which keep the
/// dynamics of steps that end elsewhere.
void MpcController::shift() {
  const int steps = options_.steps;
  for (int k = 0; k < steps; ++k) {
    old_rows_[k] = solver_.rows(k);
    old_multipliers_[k] = program_.multipliers(k);
  }
  const auto old_step = [&](double t) { return static_cast<int>(&plan_.step_at(t) - plan_.steps().data()); };
  plan_.state(grid_.time(0), q_, v_);
  for (int k = 0; k < steps; ++k) {
    const int from = old_step(grid_.middle(k));
    plan_.state(grid_.time(k + 1), q_next_, v_next_);
    a_ = (v_next_ - v_) / grid_.step(k);
    plan_.mean_torques(grid_.time(k), grid_.time(k + 1), tau_);
    program_.set_stage(k, q_, v_, a_, tau_);
    const double factor = grid_.step(k) / old_lengths_[static_cast<std::size_t>(from)];
    StageMultipliers& on = program_.multipliers(k);
    const StageMultipliers& old = old_multipliers_[static_cast<std::size_t>(from)];
    on.equalities = factor * old.equalities;
    on.inequalities = factor * old.inequalities;
    on.next = old_multipliers_[static_cast<std::size_t>(std::min(old_step(grid_.time(k + 1)), steps - 2))].next;
    solver_.rows(k).take_over(old_rows_[static_cast<std::size_t>(from)], factor);
    HorizonStep& step = program_.step(k);
    step.length = grid_.step(k);
    step.standing = standing_at(grid_.middle(k));
    step.contact_time = std::max(0.5 * grid_.step(k), k < kSoftSteps ? kContactTime : kLaterContactTime);
    std::swap(q_, q_next_);
    std::swap(v_, v_next_);
  }
  for (int k = 0; k < steps; ++k) old_lengths_[static_cast<std::size_t>(k)] = grid_.step(k);
}

/// References from where the command leads.
void MpcController::lead(double start) {
  const double cos = std::cos(heading_), sin = std::sin(heading_);
  const double dt = std::clamp(start - led_until_, 0.0, 0.1);
  led_until_ = start;
  const double standing = program_.standing_posture().z();
  const auto approach = [](double& value, double target, double most) {
    value += std::clamp(target - value, -most, most);
  };
  approach(smooth_.forward, command_.forward, dt * kMostPush * RobotModel::kGravity);
  approach(smooth_.left, command_.left, dt * kMostPush * RobotModel::kGravity);
  approach(smooth_.turn, command_.turn, dt * kMostSpin * RobotModel::kGravity / standing);
  approach(smooth_.height, command_.height, dt * kMostHeight * standing);
  const auto [forward, left, turn, raised] = smooth_;
  place_ += dt * Eigen::Vector2d(cos * forward - sin * left, sin * forward + cos * left);
  heading_ = wrapped(heading_ + dt * turn);
  for (int k = 0; k < options_.steps; ++k) {
    HorizonStep& step = program_.step(k);
    const double ahead = grid_.middle(k) - start, turned = heading_ + ahead * turn;
    const double middle = heading_ + 0.5 * ahead * turn, c = std::cos(middle), s = std::sin(middle);
    step.q_ref = program_.standing_posture();
    const Eigen::Vector2d place = place_ + ahead * Eigen::Vector2d(c * forward - s * left, s * forward + c * left);
    step.q_ref.head<3>() << place, ground_.height(place) + standing + raised;
    // The base stays parallel to the ground: the joints are as on level ground.
    set_base_rotation(step.q_ref, Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ground_.normal()) *
                                      Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ()).toRotationMatrix());
    step.v_ref.setZero();
    step.v_ref.head<2>() << forward, left;
    step.v_ref(5) = turn;
  }
}

void MpcController::set_bounds() {
  const double price = options_.weights.breach;
  const double length = program_.length_unit();
  const double speed = program_.row_unit(program_.contact_velocity_row(0));
  const double clearance = options_.clearance * program_.standing_posture().z() / length;
  for (int k = 0; k < options_.steps; ++k) {
    BarrierRows& rows = solver_.rows(k);
    const HorizonStep& step = program_.step(k);
    const double t = grid_.middle(k), soft = price * step.length;
    program_.get_state(k, q_, v_);
    for (int f = 0; f < program_.num_feet(); ++f) {
      const bool stands = ((step.standing >> f) & 1U) != 0;
      const ContactTimeline::Swing* const swing = timeline_.swing(f, t);
      const double ground = ground_under(f, q_) / length;
      double least = -kInfinity, most = kInfinity, fastest = kInfinity;
      if (swing) {
        const double s = (t - swing->lift) / (swing->land - swing->lift);
        least = ground + clearance * swing_profile(s);
        const double left = swing->land - t;
        fastest = (kLandingSpeed + kLandingBrake * left) / speed;
        if (s > 0.5) {
          least -= kPress * s / length;
          most = ground + (kLandingSpeed + 0.5 * kLandingBrake * left) * left / length;  // from where it can brake
        }
      } else if (k > 0 && ((program_.step(k - 1).standing >> f) & 1U) == 0) {
        const double late = timeline_.lateness(f, horizon_start_);
        most = ground - (kPress + kSearch * late) / length;  // lands at the start of this step
        least = most - kOnGround / length;
      }
      const double most_friction = stands ? most_friction_row(f, t) : kInfinity;
      for (const int contact : program_.feet()[static_cast<std::size_t>(f)]) {
        for (int i = 0; i < FrictionLimit::kMostRows; ++i)
          rows.set_bounds(program_.friction_row(contact) + i, stands ? 0.0 : -kInfinity, most_friction,
                          (k < kSoftSteps ? 1.0 : kFrictionPrice) * soft);
        rows.set_bounds(program_.height_row(contact), least, most, soft);
        for (int axis = 0; axis < 3; ++axis)
          rows.set_bounds(program_.contact_velocity_row(contact) + axis, -fastest, fastest, soft);
      }
    }
    for (int i = 0; i < program_.num_curve_rows(); ++i)
      rows.set_bounds(program_.curve_row() + i, 0.0, kInfinity, BarrierRows::kHard);
    for (int j = 0; j < robot_.nu(); ++j) {
      const double position = program_.row_unit(program_.position_row(j));
      const double velocity = robot_.velocity_limit()(j) / program_.row_unit(program_.velocity_row(j));
      const double torque = robot_.torque_limit()(j) / program_.row_unit(program_.torque_row(j));
      rows.set_bounds(program_.position_row(j), robot_.position_lower()(j) / position,
                      robot_.position_upper()(j) / position, soft);
      rows.set_bounds(program_.velocity_row(j), -velocity, velocity, soft);
      rows.set_bounds(program_.torque_row(j), -torque, torque, BarrierRows::kHard);
    }
  }
}

/// Upper bound of the friction rows of a contact of a foot that stands at time t: it keeps the normal force of one that
/// has not been felt yet below what it may carry, as two opposite rows add up to sqrt(2) times friction times that.
double MpcController::most_friction_row(int foot, double t) const {
  const ContactTimeline::Swing* const landed = timeline_.landed(foot, t);
  if (!landed || landed->has_touched || t - landed->land > kLandingTime) return kInfinity;
  const double load = robot_.weight() * (kLandingLoad + kLoadRate * (t - landed->land));
  const auto contacts = static_cast<double>(program_.feet()[static_cast<std::size_t>(foot)].size());
  return options_.friction / std::numbers::sqrt2 * load / contacts / program_.row_unit(program_.friction_row(0));
}

bool MpcController::plan(const VectorXd& q, const VectorXd& v, double t) {
  if (!q.allFinite() || !v.allFinite()) {
    ++counters_.failed;
    ++counters_.bad_states;
    return false;
  }
  q_ = q;
  v_ = v;
  find_ground(q, t);
  predict(q_, v_, t, horizon_start_);
  const double leash = kLeash * robot_.size();
  const Eigen::Vector2d off = place_ - q_.head<2>();
  if (off.norm() > leash) place_ = q_.head<2>() + off * (leash / off.norm());
  const double turned = wrapped(heading_ - yaw(q_));
  heading_ = yaw(q_) + std::clamp(turned, -kTurnLeash, kTurnLeash);
  if (!solver_.step(q_, v_)) {
    ++counters_.failed;
    // What the rows know by now helps the next quadratic program, unless it leads nowhere.
    is_settled_ = ++failed_in_a_row_ % kMostFailures != 0;
    return false;
  }
  failed_in_a_row_ = 0;
  is_settled_ = solver_.step_share() > kSettledShare;
  read_plan();
  return true;
}

void MpcController::predict(VectorXd& q, VectorXd& v, double from, double to) {
  while (to - from > 1e-9) {
    const double dt = std::min(kPredictionStep, to - from);
    torque(from, q, v, tau_);
    ForwardDynamics& dynamics = *dynamics_[standing_at(from + 0.5 * dt)];
    try {
      dynamics.evaluate(q, v, tau_);
      a_ = dynamics.acceleration();
    } catch (const NumericalError&) {
      a_.setZero();
    }
    q_next_ = q;
    v_next_ = v + 0.5 * dt * a_;
    const Eigen::Matrix3d rotation = base_rotation(q);
    q.head<3>() += dt * (rotation * v_next_.head<3>());
    set_base_rotation(q, rotation * so3::exp(dt * v_next_.segment<3>(3)));
    q.tail(robot_.nu()) += dt * v_next_.tail(robot_.nu());
    v += dt * a_;
    from += dt;
  }
}

/// What a failed update knows of the limits may be far off.
void MpcController::restart() {
  ++counters_.restarted;
  solver_.restart();
}

void MpcController::read_plan() {
  std::swap(plan_.steps(), previous_.steps());
  for (int k = 0; k < options_.steps; ++k) {
    MpcPlan::Step& step = plan_.steps()[static_cast<std::size_t>(k)];
    step.start = grid_.time(k);
    step.length = grid_.step(k);
    step.standing = program_.step(k).standing;
    program_.get_state(k, step.q, step.v);
    program_.get_inputs(k, step.a, step.tau);
    step.force = program_.forces(k);
    solver_.torque_gain(k, step.gain);
  }
}

/// From the contacts of feet that stand, but those that have just landed without being felt.
void MpcController::find_ground(const VectorXd& q, double t) {
  terms_.update_kinematics(q);
  for (int f = 0; f < program_.num_feet(); ++f) {
    if (timeline_.swing(f, t)) continue;
    const ContactTimeline::Swing* const landed = timeline_.landed(f, t);
    if (landed && !landed->has_touched && t - landed->land < kLandingTime) continue;
    for (const int contact : program_.feet()[static_cast<std::size_t>(f)]) {
      const double radius = robot_.contacts()[static_cast<std::size_t>(contact)].radius;
      ground_.see(contact, terms_.contact_position(contact) - radius * Eigen::Vector3d::UnitZ());
    }
  }
  ground_.fit(counters_.updates == 0 ? 1.0 : std::min(1.0, 0.01 / kGroundTime));
}

/// Height of the ground under a foot of the standing posture whose base is at q [m].
double MpcController::ground_under(int foot, const VectorXd& q) const {
  const double turned = yaw(q), c = std::cos(turned), s = std::sin(turned);
  const Eigen::Vector2d& off = offsets_[static_cast<std::size_t>(foot)];
  return ground_.height(q.head<2>() + Eigen::Vector2d(c * off.x() - s * off.y(), s * off.x() + c * off.y()));
}

void MpcController::torque(double t, const VectorXd& q, const VectorXd& v, VectorXd& tau) {
  const MpcPlan& plan = t < plan_.start() && previous_.start() <= t ? previous_ : plan_;
  if (t <= plan.end()) {
    plan.torque(t, q, v, tau);
    return;
  }
  ++counters_.damped;
  damping_torques(robot_, q, v, tau);
}

}  // namespace prowl
