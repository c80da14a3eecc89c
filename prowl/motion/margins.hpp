#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

/// Distances that a motion keeps from its hard limits, because robot and world differ from the plan. The tube of
/// deviations gives them: docs/robust.md.
struct Margins {
  /// Of one phase. Columns are times that divide it into equal parts, its start and end included; linear in between.
  struct OfPhase {
    /// Inside the friction cone of each contact of the phase, with the full friction of its surface [N].
    Eigen::MatrixXd cone;
    Eigen::MatrixXd torque;     ///< nu rows [N m]
    Eigen::MatrixXd joint;      ///< of positions, nu rows [rad, m]
    Eigen::MatrixXd clearance;  ///< of each contact of the robot above the ground, while in the air [m]
  };

  double friction = 0.0;        ///< part of the friction coefficients that stays unused [-]
  std::vector<OfPhase> phases;  ///< one for each phase; empty: no margins but friction
};

/// Column of `margins` at this part of a phase, 0 to 1.
Eigen::VectorXd margin_at(const Eigen::MatrixXd& margins, double fraction);

}  // namespace prowl
