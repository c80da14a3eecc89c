#include "prowl/dynamics/centroidal_kinematics.hpp"

#include "prowl/dynamics/spatial_cross.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

WorldInertia in_world(const RigidBody& body, const Eigen::Isometry3d& placement) {
  const Vector3d center = placement * body.center, moment = body.mass * center;
  const Matrix3d of_mass = moment.dot(center) * Matrix3d::Identity() - moment * center.transpose();
  return {body.mass, moment, placement.linear() * body.inertia * placement.linear().transpose() + of_mass};
}

void add(WorldInertia& sum, const WorldInertia& inertia) {
  sum.mass += inertia.mass;
  sum.moment += inertia.moment;
  sum.rotational += inertia.rotational;
}

/// Moves momenta from the origin to the point at `arm`.
template <class Columns>
void move_to(const Vector3d& arm, Columns& momentum) {
  for (Index i = 0; i < momentum.cols(); ++i) {
    const Vector3d linear = momentum.col(i).template head<3>();
    momentum.col(i).template tail<3>() -= arm.cross(linear);
  }
}

}  // namespace

CentroidalKinematics::CentroidalKinematics(const RobotModel& robot)
    : tree_(body_tree(robot)), placements_(robot), mass_(robot.mass()), links_(tree_.bodies.size()) {
  for (SpatialColumns* columns : {&S_, &E_, &I_S_, &F_, &momentum_dq_, &momentum_dv_}) columns->setZero(6, robot.nv());
  com_dq_.setZero(3, robot.nv());
}

void CentroidalKinematics::update(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  set_motion(q, v);
  add_up();
  const Link& all = links_.front();
  arm_ = all.inertia.moment / mass_;
  com_ = q.head<3>() + arm_;
  com_dq_.leftCols<3>().setIdentity();
  com_dq_.rightCols(com_dq_.cols() - 3) = I_S_.topRows<3>().rightCols(com_dq_.cols() - 3) / mass_;

  momentum_ = all.momentum;
  momentum_dv_ = I_S_;
  momentum_dq_ = F_;
  for (Index i = kFirstRotation; i < momentum_dq_.cols(); ++i) {
    momentum_dq_.col(i).tail<3>() -= com_dq_.col(i).cross(all.momentum.head<3>());
  }
  move_to(arm_, momentum_);
  move_to(arm_, momentum_dv_);
  move_to(arm_, momentum_dq_);
}

// Outward pass: motion of joints and bodies.
void CentroidalKinematics::set_motion(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  const std::vector<Eigen::Isometry3d>& placements = placements_.at(q);
  for (std::size_t b = 0; b < links_.size(); ++b) {
    Eigen::Isometry3d placement = placements[b];
    placement.translation() -= q.head<3>();
    const RigidBody& body = tree_.bodies[b];
    Link& link = links_[b];
    link.inertia = in_world(body, placement);
    if (b == 0) {
      S_.topLeftCorner<3, 3>() = S_.block<3, 3>(3, 3) = placement.linear();
      link.velocity.noalias() = S_.leftCols<kBaseDofs>() * v.head<kBaseDofs>();
    } else {
      const Index dof = kBaseDofs - 1 + static_cast<Index>(b);
      const Vector3d axis = placement.linear() * body.axis, origin = placement.translation();
      S_.col(dof) = body.prismatic ? spatial(axis, Vector3d::Zero()) : spatial(origin.cross(axis), axis);
      link.before = links_[body.parent].velocity;
      link.velocity = link.before + S_.col(dof) * v(dof);
      E_.col(dof) = cross(link.before, S_.col(dof));
    }
    link.momentum = link.inertia * link.velocity;
  }
}

// Inward pass: sums over the subtree behind each joint.
void CentroidalKinematics::add_up() {
  for (std::size_t b = links_.size() - 1; b > 0; --b) {
    Link& before = links_[tree_.bodies[b].parent];
    add(before.inertia, links_[b].inertia);
    before.momentum += links_[b].momentum;
  }
  for (Index i = 0; i < S_.cols(); ++i) {
    const Link& link = link_of(i);
    I_S_.col(i) = link.inertia * S_.col(i);
    if (i >= kFirstRotation) F_.col(i) = cross_force(S_.col(i), link.momentum) + link.inertia * E_.col(i);
  }
}

// Since r moves too, on_momentum = (y_linear, lambda):  lambda . (k0 - r x P)  has  -lambda x r  on
// P,  lambda x P  on r, and -lambda . (dr x dP) between them.
void CentroidalKinematics::add_hessian(const Vector3& on_com, const SpatialVector& on_momentum,
                                       Eigen::Ref<Eigen::MatrixXd> qq, Eigen::Ref<Eigen::MatrixXd> qv) const {
  const Vector3d lambda = on_momentum.tail<3>();
  const SpatialVector y = spatial(on_momentum.head<3>() - lambda.cross(arm_), lambda);
  const Vector3d on_arm = (on_com + lambda.cross(links_.front().momentum.head<3>())) / mass_;
  const Index nv = S_.cols();

  for (Index i = kFirstRotation; i < nv; ++i) {
    const Link& link = link_of(i);
    const SpatialVector S = S_.col(i), y_S = cross(y, S), F = F_.col(i), I_S = I_S_.col(i);
    const SpatialVector N = link.inertia * y_S + cross_force(S, link.inertia * y);
    const Vector3d moved = I_S.head<3>().cross(on_arm);  // w . this: the second derivative of mass r . on_arm
    const auto pair = [&](Index l) {
      return cross(y, S_.col(l)).dot(F) + E_.col(l).dot(N) + S_.col(l).tail<3>().dot(moved);
    };
    if (i < kBaseDofs) {  // base rotations do not commute: the Hessian along q ⊕ d is the mean of both orders
      for (Index l = kFirstRotation; l < kBaseDofs; ++l) {
        const double half = 0.5 * pair(l);
        qq(l, i) += half;
        qq(i, l) += half;
      }
      for (Index j = 0; j < kBaseDofs; ++j) qv(i, j) += y_S.dot(I_S_.col(j));
      continue;
    }
    for (Index l = i; l >= kFirstRotation;) {
      const double value = pair(l);
      qq(l, i) += value;
      if (l < i) qq(i, l) += value;
      qv(l, i) += cross(y, S_.col(l)).dot(I_S);
      if (l < i) qv(i, l) += S_.col(l).dot(N);
      const int parent = l < kBaseDofs ? 0 : tree_.bodies[l - 5].parent;
      l = parent > 0 ? parent + 5 : l < kBaseDofs ? l - 1 : kBaseDofs - 1;
    }
    for (Index j = 0; j < kFirstRotation; ++j) qv(i, j) += S_.col(j).dot(N);
  }
  for (Index i = kFirstRotation; i < nv; ++i) {
    const Vector3d turned = lambda.cross(com_dq_.col(i));  // lambda . (dr x u) = turned . u
    for (Index j = kFirstRotation; j < nv; ++j) {
      const double value = turned.dot(F_.col(j).head<3>());
      qq(i, j) -= value;
      qq(j, i) -= value;
    }
    for (Index j = 0; j < nv; ++j) qv(i, j) -= turned.dot(I_S_.col(j).head<3>());
  }
}

}  // namespace prowl
