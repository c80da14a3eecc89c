#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "prowl/tracking/linearised_dynamics.hpp"
#include "prowl/tracking/reference_grid.hpp"
#include "prowl/tracking/tracking_options.hpp"

namespace prowl {

/// Decay of deviations over one phase in the closed loop, in the metric of the weights, to first
/// order.
struct PhaseDecay {
  std::string name;
  double start = 0.0, end = 0.0;  ///< [s]
  int directions = 0;             ///< dimension of the deviations that the contacts allow
  double worst = 0.0;             ///< largest of |dx(end)| / |dx(start)|
  double mean = 0.0;              ///< root mean square over all directions
  std::string worst_direction;    ///< coordinate with the largest part in the worst dx(start): "base x", ...
  double bandwidth = 0.0;         ///< largest of the feedback [rad/s]; see TrackingOptions
};

/// Gains along a motion and their effect.
struct FeedbackDesign {
  std::vector<ReferencePhase> phases;               ///< of the motion, plus one for standing after it: stand_on()
  std::vector<std::vector<Eigen::MatrixXd>> gains;  ///< K of each sample of each phase, nu x 2 nv: dtau = -K dx
  std::vector<PhaseDecay> decay;                    ///< of each phase, including the landing at its end
  PhaseDecay whole;                                 ///< of the whole motion
  /// True if the final gains are stationary: S at the end is that of standing for ever; else of one
  /// more second.
  bool stands_on = false;
  /// Closed-loop poles when standing: smallest -Re (< 0: it falls), largest modulus [1/s].
  double slowest_rate = 0.0, fastest_rate = 0.0;
  double seconds = 0.0;  ///< computing time of the design [s]

  int num_samples() const {
    std::size_t samples = 0;
    for (const ReferencePhase& phase : phases) samples += phase.samples.size();
    return static_cast<int>(samples);
  }
};

/// State of the backward pass at one sample; xi (n): deviations that the contacts allow, dx = Z xi.
struct ReducedSample {
  int phase = 0, sample = 0;
  const Eigen::MatrixXd& Z;  ///< 2 nv x n, orthonormal in the weights
  const Eigen::MatrixXd& A;  ///< n x n, xi' = A xi + B dtau
  const Eigen::MatrixXd& B;  ///< n x nu
  const Eigen::MatrixXd& Q;  ///< n x n, cost xi' Q xi per second
  const Eigen::MatrixXd& S;  ///< n x n, cost to go xi' S xi
  const Eigen::MatrixXd& K;  ///< nu x 2 nv, dtau = -K dx
  /// Closed-loop effect on xi up to the next sample, or of the landing at the end of the phase; identity at the end of
  /// all.
  const Eigen::MatrixXd& step;
  const TrajectoryPoint& point;
  const LinearisedDynamics& linear;  ///< at the point
};

/// A phase for standing after the end of a motion, one step long: at rest in the last
/// configuration, with the holding torques closest to the last ones (a motion may end with an
/// acceleration). Nullopt if no torques hold it: in the air, or off balance on two point feet.
std::optional<ReferencePhase> stand_on(const RobotModel& robot, const ReferencePhase& last,
                                       const TrackingOptions& options);

/// Time-varying linear-quadratic regulator on the projected dynamics along the motion
/// (docs/tracking.md): backwards in time, on the deviations that the contacts allow, from the
/// stationary solution at the end. `on_sample` is called at each sample, last first; it may be
/// empty. Throws NumericalError with phase and time if no gains exist.
FeedbackDesign design_feedback(const MotionProblem& problem, const Trajectory& trajectory,
                               const TrackingOptions& options,
                               const std::function<void(const ReducedSample&)>& on_sample = {});

}  // namespace prowl
