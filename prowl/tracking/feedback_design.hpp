#pragma once

#include <Eigen/Core>
#include <functional>
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
};

/// Gains along a motion and what they do.
struct FeedbackDesign {
  std::vector<ReferencePhase> phases;
  std::vector<std::vector<Eigen::MatrixXd>> gains;  ///< K of each sample of each phase, nu x 2 nv: dtau = -K dx
  std::vector<PhaseDecay> decay;                    ///< of each phase, with the landing at its end
  PhaseDecay whole;                                 ///< of the whole motion
  /// The end has gains for ever: S there is that of standing on after the end. Else that of the next second.
  bool stands_on = false;
  double slowest_rate = 0.0, fastest_rate = 0.0;    ///< of the closed loop after the end, |Re| and modulus of poles [1/s]
};

/// What the backward pass sees at one sample of the grid; n deviations xi that the contacts allow, dx = Z xi.
struct ReducedSample {
  int phase = 0, sample = 0;
  const Eigen::MatrixXd& Z;  ///< 2 nv x n, orthonormal in the weights
  const Eigen::MatrixXd& A;  ///< n x n, xi' = A xi + B dtau
  const Eigen::MatrixXd& B;  ///< n x nu
  const Eigen::MatrixXd& S;  ///< n x n, cost to go xi' S xi
};

/// Time-varying linear-quadratic regulator on the projected dynamics along the motion (docs/tracking.md): backwards in time
/// over the grid, on the deviations that the contacts allow, from the stationary solution at the end. `on_sample` is called
/// at each sample, last first; it may be empty. Throws NumericalError, naming phase and time, where there are no gains.
FeedbackDesign design_feedback(const MotionProblem& problem, const Trajectory& trajectory, const TrackingOptions& options,
                               const std::function<void(const ReducedSample&)>& on_sample = {});

}  // namespace prowl
