#include "prowl/transcription/node/placement_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {

namespace {

/// Total duration of phases, free ones at the middle of their range [s]: the progress of a swing
/// must not depend on the mesh.
double time_of(const MotionProblem& problem, int first_phase, int last_phase) {
  double time = 0.0;
  for (int p = first_phase; p <= last_phase; ++p) {
    const Duration& duration = problem.phases[p].duration;
    time += 0.5 * (duration.min + duration.max);
  }
  return time;
}

/// swing_profile() also of a swing that does not land, 1 at its end, or in the air at the start, which begins at its
/// start height.
double clearance_profile(const ContactSwing& swing, double s) {
  if (swing.after < 0) return swing.before < 0 ? 0.0 : s * s;
  return swing_profile(s);
}

}  // namespace

PlacementRows::PlacementRows(const DiscreteProblem& discrete, int phase)
    : length_(discrete.problem.robot.size()),
      speed_(std::sqrt(RobotModel::kGravity * length_)),
      rows_(static_cast<std::size_t>(discrete.mesh.phases[phase].intervals()) + 1),
      kinematics_({}),
      at_rest_(Eigen::VectorXd::Zero(discrete.problem.robot.nv())),
      second_(discrete.problem.robot.nv()) {}

PlacementRows PlacementRows::motion_of_contacts(const DiscreteProblem& discrete, int phase) {
  PlacementRows result(discrete, phase);
  const Surface& surface = discrete.problem.surfaces.front();
  const std::vector<ContactPoint>& contacts = discrete.problem.robot.contacts();
  for (int c = 0; c < static_cast<int>(contacts.size()); ++c) {
    const ContactPoint& contact = contacts[c];
    const Row row{Kind::clearance,
                  result.point_of(c),
                  -1,
                  surface.normal,
                  surface.normal.dot(surface.point) + contact.radius,
                  -std::numeric_limits<double>::infinity(),
                  1.0 / result.length_,
                  contact.name + ", height above " + surface.name};
    for (std::vector<Row>& rows : result.rows_) {
      rows.push_back(row);
      for (int axis = 0; axis < 3; ++axis)
        rows.push_back({Kind::velocity, row.point, -1, surface.frame().col(axis), 0.0,
                        -std::numeric_limits<double>::infinity(), 1.0 / result.speed_, contact.name + ", velocity"});
    }
  }
  result.kinematics_ = ContactKinematics(result.points_);
  return result;
}

PlacementRows::PlacementRows(const DiscreteProblem& discrete, int phase, const std::vector<LandingAxes>& landing,
                             int intervals_at_rest)
    : PlacementRows(discrete, phase) {
  add_landing(discrete, phase, landing);
  for (const ContactSwing& swing : discrete.schedule.swings()) {
    if (swing.first_phase <= phase && phase <= swing.last_phase)
      add_clearance(discrete, phase, swing, intervals_at_rest);
  }
  kinematics_ = ContactKinematics(points_);
}

int PlacementRows::point_of(int contact) {
  const auto found = std::ranges::find(points_, contact);
  if (found != points_.end()) return static_cast<int>(found - points_.begin());
  points_.push_back(contact);
  return static_cast<int>(points_.size()) - 1;
}

void PlacementRows::add_landing(const DiscreteProblem& discrete, int phase, const std::vector<LandingAxes>& landing) {
  const MotionProblem& problem = discrete.problem;
  const auto& contacts = problem.phases[phase].contacts;
  for (int i = 0; i < static_cast<int>(contacts.size()); ++i) {
    const bool lands = discrete.schedule.lands(phase, i);
    const PhaseContact& contact = contacts[i];
    const Surface& surface = problem.surfaces[contact.surface];
    const Eigen::Matrix3d axes = surface.frame();
    const std::string& name = problem.robot.contacts()[contact.contact].name;
    const LandingAxes& along = landing[i];
    for (const int axis : along.foothold) {
      rows_[0].push_back({Kind::foothold, point_of(contact.contact), i, axes.col(axis), 0.0, 0.0, 1.0 / length_,
                          name + (lands ? ", landing place on " : ", start place on ") + surface.name});
    }
    for (const int axis : along.velocity) {
      rows_[0].push_back({Kind::velocity, point_of(contact.contact), i, axes.col(axis), 0.0, 0.0, 1.0 / speed_,
                          name + (lands ? ", velocity at landing" : ", velocity at the start")});
    }
    if (!lands || contact.foothold) continue;
    for (std::size_t corner = 0; corner < surface.patch.size(); ++corner) {
      const Eigen::Vector2d edge = surface.patch[(corner + 1) % surface.patch.size()] - surface.patch[corner];
      const Eigen::Vector3d inward = surface.axes() * Eigen::Vector2d(-edge.y(), edge.x()).normalized();
      rows_[0].push_back({Kind::inside, point_of(contact.contact), i, inward,
                          inward.dot(surface.at(surface.patch[corner])), 0.0, 1.0 / length_,
                          name + ", landing place inside " + surface.name});
    }
  }
}

void PlacementRows::add_clearance(const DiscreteProblem& discrete, int phase, const ContactSwing& swing,
                                  int intervals_at_rest) {
  const MotionProblem& problem = discrete.problem;
  const double total = time_of(problem, swing.first_phase, swing.last_phase);
  const double before = time_of(problem, swing.first_phase, phase - 1) / total;
  const double part = time_of(problem, phase, phase) / total;
  const PhaseMesh& mesh = discrete.mesh.phases[phase];
  const int intervals = mesh.intervals();
  const PhaseMesh& last = discrete.mesh.phases[swing.last_phase];
  const double last_step =
      last.step(last.intervals() - 1, time_of(problem, swing.last_phase, swing.last_phase)) / total;
  const double at_rest = swing.after < 0 ? 0.0 : intervals_at_rest * last_step;
  const double moving = at_rest < 1.0 ? 1.0 - at_rest : 1.0;
  const bool is_last_phase = phase + 1 == static_cast<int>(problem.phases.size());
  const ContactPoint& contact = problem.robot.contacts()[swing.contact];
  for (int k = 0; k <= intervals; ++k) {
    // The swing leaves at its first node and lands at its last; a phase transition in between needs
    // one node.
    if (k == 0 && phase == swing.first_phase) continue;
    if (k == intervals && !is_last_phase) continue;
    const double progress = before + mesh.node_time(k, part);
    const double risen = std::min(progress / moving, 1.0);
    const double margin = problem.margins.phases.empty() ? 0.0
                                                         : margin_at(problem.margins.phases[phase].clearance,
                                                                     mesh.node_time(k, 1.0))(swing.contact);
    const double height = std::max(problem.swing_clearance * clearance_profile(swing, risen), margin);
    for (int s = 0; s < static_cast<int>(problem.surfaces.size()); ++s) {
      const Surface& surface = problem.surfaces[s];
      if (!discrete.schedule.passes(problem, swing, s, progress)) continue;
      rows_[k].push_back({Kind::clearance, point_of(swing.contact), -1, surface.normal,
                          surface.normal.dot(surface.point) + contact.radius, height / length_, 1.0 / length_,
                          contact.name + ", clearance above " + surface.name});
    }
  }
}

int PlacementRows::most_rows() const {
  std::size_t most = 0;
  for (const std::vector<Row>& rows : rows_) most = std::max(most, rows.size());
  return static_cast<int>(most);
}

double PlacementRows::upper(int k, int row) const {
  const Kind kind = at(k, row).kind;
  return kind == Kind::foothold || kind == Kind::velocity ? at(k, row).lower : std::numeric_limits<double>::infinity();
}

std::string PlacementRows::describe(int k, int row) const { return at(k, row).what; }

void PlacementRows::evaluate(int k, const RigidBodyTerms& terms, const Eigen::VectorXd& v,
                             const Eigen::VectorXd& anchors, Eigen::Ref<Eigen::VectorXd> values) {
  if (count(k) == 0) return;
  v_ = v;
  kinematics_.set_configuration(terms);
  for (int i = 0; i < count(k); ++i) {
    const Row& row = at(k, i);
    const Eigen::Index first = 3 * row.point;
    double value = 0.0;
    switch (row.kind) {
      case Kind::foothold:
        value = row.axis.dot(kinematics_.positions().segment<3>(first) - anchors.segment<3>(3 * row.held));
        break;
      case Kind::velocity:
        value = row.axis.dot(Eigen::Vector3d(kinematics_.jacobian().middleRows<3>(first).lazyProduct(v)));
        break;
      case Kind::inside: value = row.axis.dot(anchors.segment<3>(3 * row.held)) - row.offset; break;
      case Kind::clearance: value = row.axis.dot(kinematics_.positions().segment<3>(first)) - row.offset; break;
    }
    values(i) = row.scale * value;
  }
}

void PlacementRows::derivatives(int k, Eigen::Ref<Eigen::MatrixXd> dq, Eigen::Ref<Eigen::MatrixXd> dv,
                                Eigen::Ref<Eigen::MatrixXd> danchors) {
  dq.setZero();
  dv.setZero();
  danchors.setZero();
  if (count(k) == 0) return;
  kinematics_.set_motion(at_rest_, v_);
  kinematics_.acceleration_dq(velocity_dq_);
  for (int i = 0; i < count(k); ++i) {
    const Row& row = at(k, i);
    const Eigen::Index first = 3 * row.point;
    const Eigen::RowVector3d axis = row.scale * row.axis.transpose();
    if (row.kind == Kind::velocity) {
      dq.row(i).noalias() = axis.lazyProduct(velocity_dq_.middleRows<3>(first));
      dv.row(i).noalias() = axis.lazyProduct(kinematics_.jacobian().middleRows<3>(first));
      continue;
    }
    if (row.kind == Kind::inside) {
      danchors.row(i).segment<3>(3 * row.held) = axis;
      continue;
    }
    dq.row(i).noalias() = axis.lazyProduct(kinematics_.positions_dq().middleRows<3>(first));
    if (row.kind == Kind::foothold) danchors.row(i).segment<3>(3 * row.held) = -axis;
  }
}

void PlacementRows::add_hessian(int k, const Eigen::Ref<const Eigen::VectorXd>& multipliers,
                                Eigen::Ref<Eigen::MatrixXd> qq, Eigen::Ref<Eigen::MatrixXd> vq) {
  if (count(k) == 0) return;
  on_position_.setZero(kinematics_.rows());
  on_velocity_.setZero(kinematics_.rows());
  bool any_velocity = false;
  for (int i = 0; i < count(k); ++i) {
    const Row& row = at(k, i);
    if (row.kind == Kind::inside) continue;
    any_velocity |= row.kind == Kind::velocity;
    (row.kind == Kind::velocity ? on_velocity_ : on_position_).segment<3>(3 * row.point) +=
        multipliers(i) * row.scale * row.axis;
  }
  kinematics_.add_position_hessian(on_position_, 1.0, qq);
  if (!any_velocity) return;
  second_.set_zero();
  kinematics_.set_motion(at_rest_, v_);
  kinematics_.add_acceleration_hessian(on_velocity_, 0.0, second_);
  qq += second_.qq;
  vq += second_.qa.transpose();  // J u is the acceleration of a = u at rest
}

}  // namespace prowl
