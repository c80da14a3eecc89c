#include "prowl/simulation/physics.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/model/configuration.hpp"
#include "prowl/simulation/mujoco_model.hpp"
#include "prowl/simulation/mujoco_state.hpp"

namespace prowl {

struct Physics::Engine {
  struct Delete {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  explicit Engine(MujocoModel built)
      : mujoco(std::move(built)), data(mj_makeData(mujoco.model.get())), other(mj_makeData(mujoco.model.get())) {}

  MujocoModel mujoco;
  std::unique_ptr<mjData, Delete> data, other;  ///< other: configurations beside the simulation

  const mjModel* model() const { return mujoco.model.get(); }

  /// Of the link, contact or surface: its geom's name without the kind before it.
  std::string name_of(int geom) const {
    const std::string name = mj_id2name(model(), mjOBJ_GEOM, geom);
    return name.substr(name.find_last_of(' ') + 1);
  }
};

Physics::Physics(const RobotModel& robot, const std::vector<Surface>& surfaces, const PhysicsOptions& options)
    : engine_(new Engine(make_mujoco_model(robot, surfaces, options))),
      q_(robot.nominal_configuration()),
      v_(Eigen::VectorXd::Zero(robot.nv())),
      contacts_(robot.contacts().size()) {
  set_state(q_, v_);
}

Physics::Physics(Physics&&) noexcept = default;
Physics::~Physics() = default;

double Physics::step_size() const { return engine_->model()->opt.timestep; }

double Physics::mass() const { return engine_->model()->body_subtreemass[engine_->mujoco.base_body]; }

void Physics::set_state(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  mjData* const data = engine_->data.get();
  mj_resetData(engine_->model(), data);
  q_ = q;
  v_ = v;
  Eigen::Map<Eigen::VectorXd>(data->qpos, q.size()) = mujoco_qpos(q);
  Eigen::Map<Eigen::VectorXd>(data->qvel, v.size()) = mujoco_qvel(q, v);
}

bool Physics::step(const Eigen::VectorXd& tau, const Eigen::Vector3d& push) {
  if (!tau.allFinite()) return false;  // MuJoCo would continue with zero torques
  mjData* const data = engine_->data.get();
  Eigen::Map<Eigen::VectorXd>(data->ctrl, tau.size()) = tau;
  Eigen::Map<Eigen::Vector3d>(data->xfrc_applied + 6 * engine_->mujoco.base_body) = push;
  mj_step(engine_->model(), data);
  read_contacts();
  read_state();
  return q_.allFinite() && v_.allFinite();
}

std::vector<Eigen::Vector3d> Physics::contact_positions(const Eigen::VectorXd& q) const {
  mjData* const data = engine_->other.get();
  Eigen::Map<Eigen::VectorXd>(data->qpos, q.size()) = mujoco_qpos(q);
  mj_kinematics(engine_->model(), data);
  mj_comPos(engine_->model(), data);
  std::vector<Eigen::Vector3d> positions;
  for (const int geom : engine_->mujoco.geom_of_contact)
    positions.emplace_back(Eigen::Map<const Eigen::Vector3d>(data->geom_xpos + 3 * geom));
  return positions;
}

Eigen::MatrixXd Physics::contact_jacobian(int contact) const {
  const mjData* const data = engine_->other.get();
  const int geom = engine_->mujoco.geom_of_contact[static_cast<std::size_t>(contact)];
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> jacobian(3, v_.size());
  mj_jac(engine_->model(), data, jacobian.data(), nullptr, data->geom_xpos + 3 * geom,
         engine_->model()->geom_bodyid[geom]);
  const Eigen::Quaterniond turn(data->qpos[3], data->qpos[4], data->qpos[5], data->qpos[6]);
  jacobian.leftCols<3>() = jacobian.leftCols<3>().eval() * turn.toRotationMatrix();
  return jacobian;
}

double Physics::contact_radius(int contact) const {
  return engine_->model()->geom_size[3 * engine_->mujoco.geom_of_contact[static_cast<std::size_t>(contact)]];
}

void Physics::read_state() {
  const mjData* const data = engine_->data.get();
  q_ = Eigen::Map<const Eigen::VectorXd>(data->qpos, q_.size());
  q_.segment<4>(3) << data->qpos[4], data->qpos[5], data->qpos[6], data->qpos[3];
  q_.segment<4>(3).normalize();
  v_ = Eigen::Map<const Eigen::VectorXd>(data->qvel, v_.size());
  v_.head<3>() = base_rotation(q_).transpose() * v_.head<3>();
}

void Physics::read_contacts() {
  mjData* const data = engine_->data.get();
  const mjModel* const model = engine_->model();
  contacts_.assign(contacts_.size(), {});
  other_touch_.clear();
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    contacts_[c].position = Eigen::Map<const Eigen::Vector3d>(data->geom_xpos + 3 * engine_->mujoco.geom_of_contact[c]);
  std::vector<double> largest(contacts_.size(), 0.0);
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> jacobian(3, v_.size());
  for (int i = 0; i < data->ncon; ++i) {
    const mjContact& touch = data->contact[i];
    const auto g0 = static_cast<std::size_t>(touch.geom[0]), g1 = static_cast<std::size_t>(touch.geom[1]);
    const bool robot_first = engine_->mujoco.contact_of_geom[g0] >= 0;
    const int contact = engine_->mujoco.contact_of_geom[robot_first ? g0 : g1];
    double wrench[6];
    mj_contactForce(model, data, i, wrench);
    if (!(wrench[0] > 0.0)) continue;
    if (std::max(engine_->mujoco.shape_of_geom[g0], engine_->mujoco.shape_of_geom[g1]) >= 0) {
      other_touch_ = engine_->name_of(touch.geom[0]) + " and " + engine_->name_of(touch.geom[1]);
      continue;
    }
    const Eigen::Map<const Eigen::Matrix3d> frame(touch.frame);  // columns: normal from geom 0 to geom 1, two tangents
    const double sign = robot_first ? -1.0 : 1.0;
    ContactReading& reading = contacts_[contact];
    reading.touches = true;
    reading.load += wrench[0];
    reading.force += sign * frame * Eigen::Map<const Eigen::Vector3d>(wrench);
    if (wrench[0] <= largest[contact]) continue;
    largest[contact] = wrench[0];
    reading.surface = engine_->mujoco.surface_of_geom[robot_first ? g1 : g0];
    mj_jac(model, data, jacobian.data(), nullptr, touch.pos, model->geom_bodyid[robot_first ? g0 : g1]);
    // Velocity after the step: the contact forces were solved for it.
    const Eigen::Vector3d velocity = jacobian * Eigen::Map<const Eigen::VectorXd>(data->qvel, v_.size());
    reading.slip_velocity = velocity - frame.col(0) * frame.col(0).dot(velocity);
  }
}

// v_mj = T v with T = diag(R, 1, 1); M = Tᵀ M_mj T; and M a + h for a_mj = T a + Ṫ v, Ṫ v = (R (ω × v_lin), 0, 0).
Eigen::MatrixXd Physics::mass_matrix() {
  mj_forward(engine_->model(), engine_->data.get());
  Eigen::MatrixXd mass(v_.size(), v_.size());
  mj_fullM(engine_->model(), engine_->data.get(), mass.data());
  const Eigen::Matrix3d R = base_rotation(q_);
  mass.topRows<3>() = R.transpose() * mass.topRows<3>().eval();
  mass.leftCols<3>() = mass.leftCols<3>().eval() * R;
  return mass;
}

Eigen::VectorXd Physics::bias() {
  const Eigen::MatrixXd mass = mass_matrix();
  Eigen::VectorXd bias = Eigen::Map<const Eigen::VectorXd>(engine_->data->qfrc_bias, v_.size());
  bias.head<3>() = base_rotation(q_).transpose() * bias.head<3>().eval();
  const Eigen::Vector3d v = v_.head<3>(), w = v_.segment<3>(3);
  return bias + mass.leftCols<3>() * w.cross(v);
}

const char* Physics::version() { return mj_versionString(); }

}  // namespace prowl
