#pragma once

#include <vector>

#include "prowl/mpc/barrier_rows.hpp"
#include "prowl/mpc/horizon_program.hpp"
#include "prowl/solvers/riccati/stage_kkt.hpp"

namespace prowl {

/// Real-time sequential quadratic programming on a HorizonProgram. One linearisation gives one quadratic program, which
/// an interior-point method solves twice:
///
///   prepare()  from the state that the variables predict. The first iteration begins with the previous active
///              set; if it changes, predictor-corrector iterations follow.
///   step()     from the measured state, which is near. Its first iteration has the factors of prepare(); others follow
///              only if the active set of steps that may act changes. The next prepare() sees to the rest.
class HorizonSolver {
 public:
  /// A view of `program`, which must outlive it. `barrier`: mu of a step of mean length.
  /// `iterations`, `feedback_iterations` >= 1: maximum of prepare() and step(), which end when the distances fit their
  /// rows within kTolerance.
  HorizonSolver(HorizonProgram& program, double barrier, int iterations, int feedback_iterations);

  /// Forgets distances and multipliers of all rows.
  void restart();

  BarrierRows& rows(int k) { return rows_[static_cast<std::size_t>(k)]; }

  /// Linearises at the variables of the program, solves for their start, and factorises. False if that is not
  /// possible: do not call step().
  bool prepare();
  /// After prepare(): moves all variables and multipliers by Newton's step, with this start of the first step. False if
  /// the step is not finite, or the quadratic program is far from solved; then no variable has moved.
  bool step(const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  /// After prepare(): derivative of the torques of step k in (q, v) at its start, in physical units, nu x 2 nv.
  void torque_gain(int k, Eigen::Ref<Eigen::MatrixXd> gain);

  double regularisation() const { return regularisation_; }  ///< of the latest factorisation
  /// Of the latest prepare(): largest violation of dynamics and continuity, in units of the stages.
  double violation() const { return violation_; }
  double step_share() const { return share_; }         ///< of Newton's step that was taken
  int iterations() const { return done_; }             ///< of the latest part
  double residual() const { return residual(near_); }  ///< largest of the rows of its first steps, which act

  static constexpr double kTolerance = 0.01, kUnsolved = 0.1;  ///< in units of the rows

 private:
  double scaled(double barrier, int k) const;
  double residual(int stages) const;
  void set_weights();
  void aim(double barrier);
  void correct(double barrier);
  void set_cost_gradient();
  void set_gradient();
  bool factorise();
  bool find_direction();
  double longest() const;
  void take(double share);
  double products(double share) const;
  bool solve(int judged, int most_iterations);
  bool solve_anew(int judged, int most_iterations);

  HorizonProgram& program_;
  StageKkt kkt_;
  double barrier_;
  std::vector<BarrierRows> rows_;
  int iterations_, feedback_iterations_, near_;  ///< near_: steps that may act before the next plans replace them
  double mean_length_ = 0.0;
  StageVectors weights_, pull_, cost_gradient_, gradient_, equalities_, links_;
  StageVectors step_, inequalities_;  ///< so far in the quadratic program, and its rows there
  Eigen::VectorXd nothing_, states_, start_;
  Eigen::MatrixXd gain_;
  std::vector<double> residuals_;  ///< of the rows of each step: how far distances are from them
  int done_ = 0;
  double regularisation_ = 0.0, violation_ = 0.0, share_ = 1.0;
};

}  // namespace prowl
