#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

/// Quadratic cost of the position of one contact point, 1/2 sum_i weight_i (p_i - reference_i)^2, world frame.
struct ContactPositionCost {
  int contact = 0;
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();     ///< [1/m^2], >= 0
};

/// Quadratic cost of one instant:
///
///   w_t + 1/2 ( |q (-) q_ref|^2_Wq + |v - v_ref|^2_Wv + |a|^2_Wa + |tau - tau_ref|^2_Wtau + sum_c |f_c|^2_Wf )
///   + costs of contact positions
///
/// with diagonal weights >= 0. w_t is a cost of time, for phases of free duration. The running cost is its
/// integral over time, the terminal cost its value at the last node (there only the terms of q and v count). q (-)
/// q_ref is prowl::difference(q_ref, q): its first six entries weigh the base pose. tau_ref is normally the static
/// torque of the start.
struct QuadraticCost {
  Eigen::VectorXd q_ref;  ///< nq
  Eigen::VectorXd
      configuration_weight;             ///< nv: base displacement (world) [1/m^2], rotation [1/rad^2], joints [1/rad^2]
  Eigen::VectorXd velocity_weight;      ///< nv: base twist (base frame) and joint rates [s^2/m^2, s^2/rad^2]
  Eigen::VectorXd acceleration_weight;  ///< nv, likewise [s^4/m^2, s^4/rad^2]
  Eigen::VectorXd tau_ref;              ///< nu [N m]
  Eigen::VectorXd torque_weight;        ///< nu [1/(N m)^2]
  double time_weight = 0.0;             ///< w_t [1/s]; 0 in a terminal cost
  Eigen::Vector3d force_weight = Eigen::Vector3d::Zero();  ///< world x y z, the same for every contact [1/N^2]
  std::vector<ContactPositionCost> contact_positions;
  Eigen::VectorXd v_ref = {};  ///< nv; empty: zero
};

/// 1/2 |difference(q_ref, q)|^2_W with its derivatives in the tangent at q (configuration.hpp).
struct ConfigurationCost {
  double value = 0.0;
  Eigen::VectorXd gradient;          ///< nv
  Eigen::VectorXd hessian_diagonal;  ///< nv; the rotation's entries (3 ... 5) are in the block instead
  Eigen::Matrix3d hessian_rotation;  ///< rows and columns 3 ... 5
};
ConfigurationCost configuration_cost(const Eigen::VectorXd& q_ref, const Eigen::VectorXd& weight,
                                     const Eigen::VectorXd& q);
/// The same, written to `cost`; allocates only if its sizes do not fit.
void configuration_cost(const Eigen::VectorXd& q_ref, const Eigen::VectorXd& weight, const Eigen::VectorXd& q,
                        ConfigurationCost& cost);

}  // namespace prowl
