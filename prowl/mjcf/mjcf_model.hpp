#pragma once

// Internal to mjcf: shows MuJoCo.
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace prowl {

/// A compiled MJCF file with one robot.
class MjcfModel {
 public:
  /// Throws InputError, see read_mjcf().
  explicit MjcfModel(const std::filesystem::path& file);

  const mjModel& operator*() const { return *model_; }
  const mjModel* operator->() const { return model_.get(); }

  std::string name() const;
  int base() const { return base_; }  ///< the body behind the free joint
  /// Of MuJoCo, or "body_3" for one without a name.
  std::string name_of(mjtObj kind, int id) const;
  std::vector<int> children(int body) const;
  /// Largest torque or force that the actuators of a joint exert, by their limits [N m] or [N]. None: unknown.
  std::optional<double> torque_limit(int joint) const;
  std::vector<int> actuators(int joint) const;
  /// File of a mesh; empty if its vertices are in the MJCF.
  std::filesystem::path mesh_file(int mesh) const;

 private:
  int find_base() const;

  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
  };
  std::filesystem::path file_, mesh_folder_;
  std::unique_ptr<mjModel, Delete> model_;
  int base_ = 0;
};

inline Eigen::Vector3d vector_at(const mjtNum* values, int index) {
  return Eigen::Map<const Eigen::Vector3d>(values + 3 * index);
}
inline Eigen::Matrix3d rotation_at(const mjtNum* quaternions, int index) {
  const mjtNum* const q = quaternions + 4 * index;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}
inline Eigen::Isometry3d placement_at(const mjtNum* positions, const mjtNum* quaternions, int index) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = rotation_at(quaternions, index);
  result.translation() = vector_at(positions, index);
  return result;
}

}  // namespace prowl
