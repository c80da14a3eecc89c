#include "alternatives/centroidal/centroidal_node.hpp"

#include <cmath>
#include <limits>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/transcription/node/node_functions.hpp"

namespace prowl {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// v at a node is the velocity of the interval before it: a contact at rest at landing was down one
/// node earlier.
constexpr int kIntervalsAtRest = 1;

std::vector<LandingAxes> without_footholds(std::vector<LandingAxes> landing) {
  for (LandingAxes& axes : landing) axes.foothold.clear();
  return landing;
}

}  // namespace

CentroidalScale::CentroidalScale(const RobotModel& robot)
    : length(robot.size()),
      speed(std::sqrt(RobotModel::kGravity * length)),
      force(robot.weight()),
      momentum(robot.mass() * speed * length) {}

// The variable c replaces the foothold, so PlacementRows need not fix it.
CentroidalNode::CentroidalNode(const DiscreteProblem& discrete, int phase, std::vector<LandingAxes> landing,
                               CentroidalContacts contacts, std::vector<bool> ties)
    : nv_(discrete.problem.robot.nv()),
      nu_(discrete.problem.robot.nu()),
      intervals_(discrete.mesh.phases[phase].intervals()),
      scale_(discrete.problem.robot),
      mass_(discrete.problem.robot.mass()),
      first_columns_(nv_, static_cast<int>(discrete.problem.phases[phase].contacts.size()), false),
      columns_(nv_, static_cast<int>(discrete.problem.phases[phase].contacts.size()), true),
      contact_indices_(contact_indices(discrete.problem.phases[phase].contacts)),
      ties_(std::move(ties)),
      held_(std::move(contacts)),
      placement_(discrete, phase, without_footholds(std::move(landing)), kIntervalsAtRest),
      cost_(discrete.problem),
      kinematics_(discrete.problem.robot),
      terms_(discrete.problem.robot),
      points_(contact_indices_),
      tau_ref_(discrete.problem.running_cost.tau_ref),
      positions_cost_(!discrete.problem.running_cost.contact_positions.empty() ||
                      !discrete.problem.terminal_cost.contact_positions.empty()) {
  const MotionProblem& problem = discrete.problem;
  const auto& held = problem.phases[phase].contacts;
  for (int i = 0; i < static_cast<int>(held.size()); ++i) {
    const PhaseContact& contact = held[i];
    const Surface& surface = problem.surfaces[contact.surface];
    const Phase& held_in = problem.phases[phase];
    friction_.emplace_back(problem.friction_model, surface, cone_smoothing(problem, held_in, contact),
                           least_load(problem, held_in, contact));
    contact_names_.push_back(problem.robot.contacts()[contact.contact].name);
    opens_.push_back(discrete.schedule.opens(phase, i));
  }
  for (int k = 0; k <= intervals_; ++k) {
    std::array<int, kinds + 1>& first = first_rows_.emplace_back();
    first[0] = 0;
    for (std::size_t kind = 0; kind < kinds; ++kind)
      first[kind + 1] = first[kind] + count_rows(k, static_cast<Kind>(kind));
  }
}

int CentroidalNode::count_rows(int k, Kind kind) const {
  int count = 0;
  switch (kind) {
    case newton:
    case moment: return k > 0 ? 3 : 0;
    case momentum:
    case com: return 3;
    case positions: return 3 * num_contacts();
    case distance: return static_cast<int>(directions(k).size());
    case com_velocity: return ties_[k] ? 3 : 0;
    case placement: return placement_.count(k);
    case friction:
    case unloaded:
      for (int i = 0; k > 0 && i < num_contacts(); ++i) {
        if (unloads(k, i) != (kind == unloaded)) continue;
        count += kind == unloaded ? 3 : friction_[i].count();
      }
      return count;
    default: return 0;
  }
}

double CentroidalNode::lower(int k, int row) const {
  return row < first_row(k, placement) ? 0.0 : placement_.lower(k, row - first_row(k, placement));
}

double CentroidalNode::upper(int k, int row) const {
  if (row >= first_row(k, placement)) return placement_.upper(k, row - first_row(k, placement));
  const bool is_friction = row >= first_row(k, friction) && row < first_row(k, unloaded);
  return is_friction ? std::numeric_limits<double>::infinity() : 0.0;
}

std::vector<RowGroup> CentroidalNode::row_groups(int k) const {
  constexpr const char* kNames[] = {"m r'' = sum f + m g",
                                    "h' = sum (c - r) x f",
                                    "h = A_G(q) v",
                                    "r = com(q)",
                                    "c = p(q)",
                                    "distance of contacts to their surfaces",
                                    "friction",
                                    "no force before a contact opens",
                                    "r' = velocity of com(q)",
                                    "landing and clearance of contacts"};
  std::vector<RowGroup> groups;
  for (int kind = 0; kind < kinds; ++kind) {
    if (count(k, kind) > 0) groups.push_back({kNames[kind], count(k, kind)});
  }
  return groups;
}

std::string CentroidalNode::describe_row(int k, int row) const {
  if (row >= first_row(k, placement)) return placement_.describe(k, row - first_row(k, placement));
  const auto axis = [](int i) { return std::string(1, "xyz"[i % 3]); };
  int kind = 0;
  while (row >= first_row(k, kind + 1)) ++kind;
  const int i = row - first_row(k, kind);
  if (kind == distance) return directions(k)[i].what;
  if (kind == positions) return contact_names_[i / 3] + ", position " + axis(i);
  if (kind == friction || kind == unloaded) {
    int end = 0;
    for (int contact = 0; contact < num_contacts(); ++contact) {
      if (unloads(k, contact) != (kind == unloaded)) continue;
      end += kind == unloaded ? 3 : friction_[contact].count();
      if (i >= end) continue;
      return contact_names_[contact] + (kind == friction ? ", friction cone" : ", force before it opens, " + axis(i));
    }
  }
  constexpr const char* kWhat[] = {"forces", "moments", "angular momentum", "centre of mass"};
  return (kind == com_velocity ? "velocity of the centre of mass" : std::string(kWhat[kind])) + ", " + axis(i);
}

VectorXd CentroidalNode::configuration(const CentroidalPoint& point) const {
  VectorXd q(nv_ + 1);
  q.head<3>() = point.x.head<3>();
  set_base_rotation(q, point.chart * so3::exp(point.x.segment<3>(3)));
  q.tail(nu_) = point.x.segment(6, nu_);
  return q;
}

// The costed base acceleration is r''; joint accelerations have their cost in the intervals; there
// are no torques.
void CentroidalNode::set_cost_point(const CentroidalPoint& point) {
  const CentroidalColumns& at = columns(point.node);
  cost_point_.node = point.node;
  cost_point_.q = configuration(point);
  cost_point_.theta = point.x.segment<3>(3);
  cost_point_.v = point.x.segment(at.v, nv_);
  cost_point_.a.setZero(nv_);
  if (at.ends_interval()) cost_point_.a.head<3>() = point.x.segment<3>(at.com_acceleration);
  cost_point_.tau = tau_ref_;
  cost_point_.duration = point.duration;
  cost_point_.cost_weight = point.cost_weight;
  cost_point_.terminal_weight = point.terminal_weight;
  forces_ = at.ends_interval() ? VectorXd(point.x.segment(at.forces, 3 * num_contacts())) : VectorXd();
}

void CentroidalNode::evaluate(const CentroidalPoint& point, CentroidalValues& values) {
  const int k = point.node;
  const CentroidalColumns& at = columns(k);
  const VectorXd& x = point.x;
  set_cost_point(point);
  terms_.update_kinematics(cost_point_.q);
  points_.set_configuration(terms_);
  kinematics_.update(cost_point_.q, cost_point_.v);
  values.cost = cost_.value(cost_point_, terms_, forces_);

  VectorXd& rows = values.rows;
  rows.resize(num_rows(k));
  const Vector3d r = x.segment<3>(at.com);
  const VectorXd c = x.segment(at.contacts, 3 * num_contacts());
  if (at.ends_interval()) {
    Vector3d force = scale_.force * Vector3d::UnitZ() + mass_ * x.segment<3>(at.com_acceleration);
    Vector3d turning = x.segment<3>(at.momentum_rate);
    int cone = first_row(k, friction), no_force = first_row(k, unloaded);
    for (int i = 0; i < num_contacts(); ++i) {
      const Vector3d f = forces_.segment<3>(3 * i);
      force -= f;
      turning -= (c.segment<3>(3 * i) - r).cross(f);
      const FrictionLimit& limit = friction_[i];
      if (unloads(k, i)) {
        rows.segment<3>(no_force) = f / scale_.force;
        no_force += 3;
      } else {
        rows.segment(cone, limit.count()) = limit.rows(f) / scale_.force;
        cone += limit.count();
      }
    }
    rows.segment<3>(first_row(k, newton)) = force / scale_.force;
    rows.segment<3>(first_row(k, moment)) = turning / (scale_.force * scale_.length);
  }
  rows.segment<3>(first_row(k, momentum)) =
      (x.segment<3>(at.momentum) - kinematics_.momentum().tail<3>()) / scale_.momentum;
  rows.segment<3>(first_row(k, com)) = (r - kinematics_.com()) / scale_.length;
  rows.segment(first_row(k, positions), c.size()) = (c - points_.positions()) / scale_.length;
  for (int i = 0; i < count(k, distance); ++i) {
    const HeldDirection& held = directions(k)[i];
    rows(first_row(k, distance) + i) = (held.axis.dot(c.segment<3>(3 * held.contact)) - held.offset) / scale_.length;
  }
  if (count(k, com_velocity) > 0) {
    rows.segment<3>(first_row(k, com_velocity)) =
        (x.segment<3>(at.com_velocity) - kinematics_.momentum().head<3>() / mass_) / scale_.speed;
  }
  placement_.evaluate(k, terms_, cost_point_.v, c, rows.segment(first_row(k, placement), count(k, placement)));
}

}  // namespace prowl
