#pragma once

#include <vector>

#include "prowl/mpc/barrier_rows.hpp"
#include "prowl/mpc/horizon_program.hpp"
#include "prowl/solvers/riccati/stage_kkt.hpp"

namespace prowl {

/// Real-time sequential quadratic programming on a HorizonProgram. One linearisation gives one quadratic program, which
/// an interior-point method solves:
///
///   prepare()  from the state that the variables predict. The first iteration begins with the previous active
///              set; if it changes, predictor-corrector iterations follow. Then all is ready for another state.
///   step()     from the measured state, which is near, with these factors. If rows of the near steps do not fit,
///   others
///              follow for these steps alone, before the cost-to-go that prepare() found. Later steps follow by one
///              step of Newton's: if their active set changes, the next prepare() finds that.
class HorizonSolver {
 public:
  /// A view of `program`, which must outlive it. `barrier`: mu of a step of mean length.
  /// `iterations`, `feedback_iterations` >= 1: maximum of prepare() and step(), which end when the distances fit their
  /// rows within kTolerance; in step() those of the near steps.
  HorizonSolver(HorizonProgram& program, double barrier, int iterations, int feedback_iterations);

  /// Forgets distances and multipliers of all rows.
  void restart();

  BarrierRows& rows(int k) { return rows_[static_cast<std::size_t>(k)]; }

  /// Linearises at the variables of the program, solves for their start, and factorises. False if that is not
  /// possible: do not call step().
  bool prepare();
  /// After prepare(): moves all variables and multipliers by Newton's step, with this start of the first step. False if
  /// the step is not finite, or rows of the near steps are far from fitting; then no variable has moved.
  bool step(const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  /// After prepare(): derivative of the torques of step k in (q, v) at its start, in physical units, nu x 2 nv.
  void torque_gain(int k, Eigen::Ref<Eigen::MatrixXd> gain);

  double regularisation() const { return regularisation_; }  ///< of the latest factorisation
  /// Of the latest prepare(): largest violation of dynamics and continuity, in units of the stages.
  double violation() const { return violation_; }
  double step_share() const { return share_; }         ///< of Newton's step that was taken
  int iterations() const { return done_; }             ///< of the latest part
  double residual() const { return residual(near_); }  ///< largest of the rows of the near steps

  static constexpr double kTolerance = 0.01, kUnsolved = 0.1;  ///< in units of the rows

 private:
  double scaled(double barrier, int k) const;
  double residual(int stages) const;
  const Eigen::VectorXd& values(int k);
  bool set_up(int stages, double barrier);
  bool factorise(int stages);
  void sweep_back(int stages);
  bool find_direction(int begin, int end);
  double longest(int stages) const;
  void take(int begin, int end, double share);
  double products(int stages, double share) const;
  bool solve(int stages, int most_iterations);
  bool solve_anew(int stages, int most_iterations);
  bool follow_near();

  HorizonProgram& program_;
  StageKkt kkt_;
  double barrier_;
  std::vector<BarrierRows> rows_;
  int iterations_, feedback_iterations_, near_;  ///< near_: number of the near steps
  double mean_length_ = 0.0;
  StageVectors weights_, pull_, gradient_, equalities_, links_;
  StageVectors step_, along_;  ///< so far in the quadratic program, and by how much that changes its rows
  Eigen::VectorXd nothing_, states_, after_near_, values_, change_;
  Eigen::MatrixXd gain_;
  std::vector<double> residuals_;  ///< of the rows of each step: how far distances are from them
  int done_ = 0;
  double regularisation_ = 0.0, violation_ = 0.0, share_ = 1.0;
};

}  // namespace prowl
