#include "prowl/mpc/mpc_controller.hpp"

#include <algorithm>

#include "prowl/error.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// Velocities of contacts that stand decay with these time constants at least [s]. In the first steps slowly, as what
/// is measured of them is mostly noise. Later at once in effect: slower decay holds more kicks, but lets feet creep.
constexpr double kContactTime = 0.05, kLaterContactTime = 0.02;
constexpr int kMostFailures = 5;       ///< in a row, before an update starts anew
constexpr double kSettledShare = 0.5;  ///< of a step; with less, the next update starts anew
constexpr double kGroundTime = 0.1;    ///< filter of height and slope of the ground [s]
constexpr int kFirstIterations = 30;   ///< of the plan with which a controller begins

}  // namespace

MpcController::MpcController(const RobotModel& robot, const MpcOptions& options, const VectorXd& q, const VectorXd& v,
                             double t)
    : OnlineController(robot, options.delay, q, t, options_for(robot, options).steps, MpcPlan::kMostFeedback),
      options_(options_for(robot, options)),
      program_(robot, options_.weights, options_.friction, options_.steps),
      solver_(program_, options_.barrier, options_.iterations, options_.feedback_iterations),
      grid_(options_.steps, options_.first_step, options_.least_horizon),
      terms_(robot_),
      ground_(static_cast<int>(robot.contacts().size()), robot.size()),
      bounds_(program_, options_) {
  const MpcPlan::Step still = standing_step(robot_, feet_, q);
  q_ = q_next_ = q;
  v_ = v_next_ = VectorXd::Zero(robot.nv());
  a_ = v_;
  tau_ = still_torques_ = still.tau;
  failed_at_ = q;
  grid_.lay(t, timeline_);
  MpcPlan& plan = plans_.begin_next();
  for (int k = 0; k < options_.steps; ++k) {
    MpcPlan::Step& step = plan.steps()[static_cast<std::size_t>(k)];
    step = still;
    step.start = grid_.time(k);
    step.length = grid_.step(k);
    old_rows_.push_back(solver_.rows(k));
    old_multipliers_.push_back(program_.multipliers(k));
    old_times_.push_back(grid_.time(k));
  }
  old_times_.push_back(grid_.end());
  program_.use_hessian(options_.hessian);
  look(q, t);
  bool solved = false;
  for (int i = 0; i < kFirstIterations; ++i) solved = update(q, v, t);
  if (!solved) throw InputError(robot.name() + ": no plan holds the robot in its standing posture");
  counters_ = {};
}

void MpcController::follow(const SteppingPattern& pattern) {
  OnlineController::follow(pattern);
  grid_ = HorizonGrid(options_.steps, options_.first_step, std::max(options_.least_horizon, pattern.stride));
}

bool MpcController::prepare_from(double start) {
  if (!is_settled_) restart();
  timeline_.extend(start, start + grid_.length() + 0.1);
  grid_.lay(start, timeline_);
  shift();
  if (is_lost()) begin_anew();
  lead_.lead(start, grid_, ground_, program_);
  bounds_.set(grid_, timeline_, ground_, solver_);
  is_settled_ = solver_.prepare();
  if (solver_.regularisation() > 0.0) ++counters_.regularised;
  return is_settled_;
}

/// Puts the last plan on the new steps: its states, and the means of its accelerations and torques, which keep the
/// dynamics of steps that end elsewhere. Distances and multipliers are those of the last program, which is of other
/// times if it had no solution.
void MpcController::shift() {
  const int steps = options_.steps;
  const MpcPlan& old_plan = plans_.latest();
  for (int k = 0; k < steps; ++k) {
    old_rows_[k] = solver_.rows(k);
    old_multipliers_[k] = program_.multipliers(k);
  }
  const auto old_step = [&](double t) {
    const auto after_last = std::upper_bound(old_times_.begin() + 1, old_times_.end() - 1, t);
    return static_cast<std::size_t>(after_last - old_times_.begin()) - 1;
  };
  old_plan.state(grid_.time(0), q_, v_);
  for (int k = 0; k < steps; ++k) {
    const std::size_t from = old_step(grid_.middle(k));
    old_plan.state(grid_.time(k + 1), q_next_, v_next_);
    a_ = (v_next_ - v_) / grid_.step(k);
    old_plan.mean_torques(grid_.time(k), grid_.time(k + 1), tau_);
    program_.set_stage(k, q_, v_, a_, tau_);
    const double factor = grid_.step(k) / (old_times_[from + 1] - old_times_[from]);
    StageMultipliers& on = program_.multipliers(k);
    const StageMultipliers& old = old_multipliers_[from];
    on.equalities = factor * old.equalities;
    on.inequalities = factor * old.inequalities;
    on.next = old_multipliers_[std::min(old_step(grid_.time(k + 1)), old_multipliers_.size() - 2)].next;
    solver_.rows(k).copy(old_rows_[from], factor);
    HorizonStep& step = program_.step(k);
    step.length = grid_.step(k);
    step.standing = timeline_.standing(grid_.middle(k));
    step.contact_time = std::max(0.5 * grid_.step(k), k < HorizonBounds::kSoftSteps ? kContactTime : kLaterContactTime);
    std::swap(q_, q_next_);
    std::swap(v_, v_next_);
  }
  for (int k = 0; k <= steps; ++k) old_times_[static_cast<std::size_t>(k)] = grid_.time(k);
}

bool MpcController::plan_from(const VectorXd& q, const VectorXd& v, double) {
  if (!solver_.step(q, v)) {
    // What the rows know by now helps the next quadratic program, unless it leads nowhere.
    ++failed_in_a_row_;
    failed_at_ = q;
    is_settled_ = !is_lost();
    return false;
  }
  failed_in_a_row_ = 0;
  is_settled_ = solver_.step_share() > kSettledShare;
  read_plan();
  return true;
}

/// The last plan is no good guess any more.
bool MpcController::is_lost() const { return failed_in_a_row_ > 0 && failed_in_a_row_ % kMostFailures == 0; }

/// From where the robot is, as if it stood still there.
void MpcController::begin_anew() {
  v_.setZero();
  a_.setZero();
  for (int k = 0; k < options_.steps; ++k) program_.set_stage(k, failed_at_, v_, a_, still_torques_);
}

/// What a failed update knows of the limits may be far off.
void MpcController::restart() {
  ++counters_.restarted;
  solver_.restart();
}

void MpcController::read_plan() {
  MpcPlan& plan = plans_.begin_next();
  for (int k = 0; k < options_.steps; ++k) {
    MpcPlan::Step& step = plan.steps()[static_cast<std::size_t>(k)];
    step.start = grid_.time(k);
    step.length = grid_.step(k);
    step.standing = program_.step(k).standing;
    program_.get_state(k, step.q, step.v);
    program_.get_inputs(k, step.a, step.tau);
    step.force = program_.forces(k);
    solver_.torque_gain(k, step.gain);
  }
}

/// From the contacts of feet that stand and touch, but those that have just landed without being felt.
void MpcController::look(const VectorXd& q, double t) {
  terms_.update_kinematics(q);
  for (int f = 0; f < program_.num_feet(); ++f) {
    if (timeline_.swing(f, t) || timeline_.unfelt(f, t) || !timeline_.touches(f)) continue;
    for (const int contact : program_.feet()[static_cast<std::size_t>(f)]) {
      const double radius = robot_.contacts()[static_cast<std::size_t>(contact)].radius;
      ground_.see(contact, terms_.contact_position(contact) - radius * Eigen::Vector3d::UnitZ());
    }
  }
  ground_.fit(counters_.updates == 0 ? 1.0 : std::clamp((t - ground_seen_) / kGroundTime, 0.0, 1.0));
  ground_seen_ = t;
}

}  // namespace prowl
