#pragma once

#include <vector>

#include "prowl/mpc/barrier_rows.hpp"
#include "prowl/mpc/horizon_program.hpp"
#include "prowl/solvers/riccati/stage_kkt.hpp"

namespace prowl {

/// Steps of an interior-point method on a HorizonProgram, each in two parts: all that the measured state does not
/// change, and the rest. A step solves the quadratic program of one linearisation. Its first iteration has the factors
/// of prepare() and the active bounds of the step before. If these change, predictor-corrector iterations follow.
class HorizonSolver {
 public:
  /// A view of `program`, which must outlive it. `barrier`: mu of a step of mean length.
  /// `iterations` >= 1: most of each quadratic program. It ends when the distances fit their rows within kTolerance.
  HorizonSolver(HorizonProgram& program, double barrier, int iterations);

  /// Forgets distances and multipliers of all rows.
  void restart();

  BarrierRows& rows(int k) { return rows_[static_cast<std::size_t>(k)]; }

  /// Linearises at the variables of the program and factorises. False if that is not possible: do not call step().
  bool prepare();
  /// After prepare(): moves all variables and multipliers by Newton's step, with this start of the first step. False if
  /// the step is not finite, or the quadratic program is far from solved; then no variable has moved.
  bool step(const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  /// After prepare(): derivative of the torques of step k in (q, v) at its start, in physical units, nu x 2 nv.
  void torque_gain(int k, Eigen::Ref<Eigen::MatrixXd> gain);

  double regularisation() const { return regularisation_; }  ///< of the latest factorisation
  /// Of the latest prepare(): largest violation of dynamics and links, in units of the stages.
  double violation() const { return violation_; }
  double step_share() const { return share_; }        ///< of Newton's step that was taken
  int iterations() const { return done_; }            ///< of the latest quadratic program
  double residual() const { return near_residual_; }  ///< largest of the rows of its first steps, which act

  static constexpr double kTolerance = 0.01, kUnsolved = 0.1;  ///< in units of the rows

 private:
  double scaled(double barrier, int k) const;
  void set_weights();
  void aim(double barrier);
  void correct(double barrier);
  void set_gradient();
  bool factorise();
  bool find_direction();
  double longest() const;
  void take(double share);
  double products(double share) const;
  bool solve_anew();

  HorizonProgram& program_;
  StageKkt kkt_;
  double barrier_;
  std::vector<BarrierRows> rows_;
  int iterations_;
  double mean_length_ = 0.0;
  StageVectors weights_, pull_, gradient_, equalities_, links_;
  StageVectors step_, inequalities_;  ///< so far in the quadratic program, and its rows there
  Eigen::VectorXd nothing_, states_, start_;
  Eigen::MatrixXd gain_;
  int done_ = 0;
  double residual_ = 0.0, near_residual_ = 0.0;
  double regularisation_ = 0.0, violation_ = 0.0, share_ = 1.0;
};

}  // namespace prowl
