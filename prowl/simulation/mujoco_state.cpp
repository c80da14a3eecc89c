#include "prowl/simulation/mujoco_state.hpp"

#include "prowl/model/configuration.hpp"

namespace prowl {

Eigen::VectorXd mujoco_qpos(const Eigen::VectorXd& q) {
  Eigen::VectorXd qpos = q;
  qpos.segment<4>(3) << q(6), q(3), q(4), q(5);
  return qpos;
}

Eigen::VectorXd mujoco_qvel(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  Eigen::VectorXd qvel = v;
  qvel.head<3>() = base_rotation(q) * v.head<3>();
  return qvel;
}

}  // namespace prowl
