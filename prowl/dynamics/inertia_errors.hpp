#pragma once

#include <Eigen/Core>
#include <memory>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// How inverse dynamics change when masses are not as modelled. One object holds the work space of one thread.
class InertiaErrors {
 public:
  explicit InertiaErrors(const RobotModel& robot);
  InertiaErrors(InertiaErrors&&) noexcept;
  ~InertiaErrors();

  int count() const { return bodies_ + 3; }

  /// Change of r0(q, v, a), see RigidBodyTerms: nv x count(). Column b: mass and inertia of body b (the base, then one
  /// for each joint) larger by the share `mass` [-]. The last three: centre of mass of the base displaced by `center`
  /// [m] along its axes.
  Eigen::MatrixXd forces(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a, double mass,
                         double center);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
  int bodies_;
};

}  // namespace prowl
