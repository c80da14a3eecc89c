#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "prowl/tracking/reference_grid.hpp"
#include "prowl/tracking/tracking_options.hpp"

namespace prowl {

/// How the closed loop treats deviations over one phase, in the metric of the weights, to first order.
struct PhaseDecay {
  std::string name;
  double start = 0.0, end = 0.0;  ///< [s]
  int directions = 0;             ///< deviations that the contacts allow
  double worst = 0.0;             ///< largest of |dx(end)| / |dx(start)|
  double mean = 0.0;              ///< root mean square of it over all directions
  std::string worst_direction;    ///< coordinate with the largest part in the worst dx(start): "base x", ...
  double bandwidth = 0.0;         ///< largest of the feedback [rad/s], see TrackingOptions
};

/// Gains along a motion and what they do.
struct FeedbackDesign {
  std::vector<ReferencePhase> phases;               ///< of the motion; if it stands on, one more, see stand_on()
  std::vector<std::vector<Eigen::MatrixXd>> gains;  ///< K of each sample of each phase, nu x 2 nv: dtau = -K dx
  std::vector<PhaseDecay> decay;                    ///< of each phase, with the landing at its end
  PhaseDecay whole;                                 ///< of the whole motion
  /// The gains at the end are for ever: S there is that of standing on. Else S is that of one more second.
  bool stands_on = false;
  double slowest_rate = 0.0,
         fastest_rate = 0.0;  ///< of standing on: least -Re (< 0: it falls) and modulus of closed-loop poles [1/s]
  double seconds = 0.0;       ///< that the design took

  int num_samples() const {
    std::size_t samples = 0;
    for (const ReferencePhase& phase : phases) samples += phase.samples.size();
    return static_cast<int>(samples);
  }
};

/// What the backward pass sees at one sample of the grid; n deviations xi that the contacts allow, dx = Z xi.
struct ReducedSample {
  int phase = 0, sample = 0;
  const Eigen::MatrixXd& Z;  ///< 2 nv x n, orthonormal in the weights
  const Eigen::MatrixXd& A;  ///< n x n, xi' = A xi + B dtau
  const Eigen::MatrixXd& B;  ///< n x nu
  const Eigen::MatrixXd& S;  ///< n x n, cost to go xi' S xi
};

/// The phase after the end of a motion, one step long: at rest in the last configuration, on its contacts, with the
/// torques that keep it there, which are nearest to the last ones (a motion may end with an acceleration). None where
/// no torques do: in the air, on two point feet off balance.
std::optional<ReferencePhase> stand_on(const RobotModel& robot, const ReferencePhase& last,
                                       const TrackingOptions& options);

/// Time-varying linear-quadratic regulator on the projected dynamics along the motion (docs/tracking.md): backwards in
/// time over the grid, on the deviations that the contacts allow, from the stationary solution at the end. `on_sample`
/// is called at each sample, last first; it may be empty. Throws NumericalError, naming phase and time, where there are
/// no gains.
FeedbackDesign design_feedback(const MotionProblem& problem, const Trajectory& trajectory,
                               const TrackingOptions& options,
                               const std::function<void(const ReducedSample&)>& on_sample = {});

}  // namespace prowl
