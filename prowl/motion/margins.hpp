#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

/// What a motion leaves of its hard limits, for a robot and a world that are not quite as planned. Found from the tube
/// of deviations: docs/robust.md.
struct Margins {
  /// Of one phase. Columns are moments that divide it into equal parts, from its start to its end; between them linear.
  struct OfPhase {
    Eigen::MatrixXd
        cone;  ///< inside the friction cone of each contact of the phase, at its surface's full friction [N]
    Eigen::MatrixXd torque;     ///< nu rows [N m]
    Eigen::MatrixXd joint;      ///< of positions, nu rows [rad, m]
    Eigen::MatrixXd clearance;  ///< below each contact of the robot while it is in the air [m]
  };

  double friction = 0.0;        ///< part of the coefficients of friction that is not used [-]
  std::vector<OfPhase> phases;  ///< one for each phase; none: only friction
};

/// Column of `margins` at this part of a phase, 0 to 1.
Eigen::VectorXd margin_at(const Eigen::MatrixXd& margins, double fraction);

}  // namespace prowl
