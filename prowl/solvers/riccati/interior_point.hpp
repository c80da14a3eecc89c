#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>

#include "prowl/nlp/iterate.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/nlp/thread_team.hpp"
#include "prowl/solvers/riccati/filter.hpp"
#include "prowl/solvers/riccati/slacks.hpp"
#include "prowl/solvers/riccati/stage_kkt.hpp"

namespace prowl {

/// Interior point method with filter line search (Wächter and Biegler 2006) on a chain of stages:
///
///   minimise    cost - mu sum log(distances of s from its bounds)
///   subject to  x_{k+1} = next,  equalities = 0,  inequalities = s
///
/// for mu -> 0. StageKkt computes each step with the exact Hessian. docs/solvers.md.
class InteriorPoint {
 public:
  /// `threads`: for the evaluation of stages; `nlp` must be prepared for them (Nlp::use_threads).
  InteriorPoint(StagewiseNlp& nlp, const SolverOptions& options, int threads);

  struct Ending {
    SolveStatus status;
    std::string message;
  };
  /// Called once per iteration; a returned Ending stops the solve.
  using Watch = std::function<std::optional<Ending>(int iteration, const IterateFigures& figures)>;
  /// The caller's own test of feasibility, in the units of the program: those of the stages differ.
  using Test = std::function<bool(const StageVectors& stages)>;
  Ending run(const StageVectors& guess, const Watch& watch, const Test& is_feasible);

  int iterations() const { return iterations_; }
  int pivoted_stages() const { return kkt_.num_pivoted(); }  ///< of the latest factorisation
  const IterateFigures& figures() const { return figures_; }
  const StageVectors& stages() const { return ux_; }
  const SolveTimes& times() const { return times_; }
  std::vector<StageMultipliers> multipliers() const;  ///< of the original program, cost not scaled

 private:
  /// Values of all functions at a point.
  struct Values {
    double cost = 0.0;
    Eigen::VectorXd stage_costs;
    StageVectors links, equalities;  ///< next - x_{k+1}, equalities
    Eigen::VectorXd inequalities;
  };

  template <class Function>
  void at_stage(int k, Function function) const;
  bool evaluate(const StageVectors& ux, Values& values);
  void evaluate_stage(int k, const StageVectors& ux, Values& values);
  void need_finite_slopes(int k) const;
  void linearise();
  void linearise_to_first_order();
  double violation(const Values& values, const Eigen::VectorXd& s) const;          ///< sum of absolute values (L1)
  double largest_violation(const Values& values, const Eigen::VectorXd& s) const;  ///< in units of the stages
  double barrier_function(const Values& values, const Slacks& slacks) const;
  void update_dual_violation();
  double error(double mu) const;
  void update_figures();
  std::optional<Ending> has_converged(const Test& is_feasible);
  bool raise_barrier();
  bool update_barrier();

  StageKkt::Outcome factorise(StageKkt::Hessian hessian, double delta);
  bool has_warm_start_multipliers() const;
  void initialise_slacks();
  void estimate_multipliers();
  double largest_multiplier() const;
  void scale_cost();
  bool compute_direction(double least_regularisation, std::string& failure);
  void set_right_sides(const Values& values, const Eigen::VectorXd& s);
  void set_gradient(double cost_scale, const Eigen::VectorXd& lambda);
  void set_weights();
  void solve_direction(double cost_scale, const Eigen::VectorXd& residual);
  void keep_point();
  void end_whole_steps();
  bool search_line();
  bool try_step(double alpha, const StageVectors& steps, const Eigen::VectorXd& ds);
  bool is_acceptable(double alpha, double theta, double phi, bool& is_phi_step) const;
  bool correct_second_order(double alpha, double theta);
  void accept(double alpha_primal, double alpha_dual);
  std::optional<Ending> restore_feasibility(const Watch& watch);

  Eigen::Index row(int k) const { return rows_[k]; }
  auto segment(Eigen::VectorXd& all, int k) const { return all.segment(row(k), row(k + 1) - row(k)); }
  auto segment(const Eigen::VectorXd& all, int k) const { return all.segment(row(k), row(k + 1) - row(k)); }

  StagewiseNlp& nlp_;
  const SolverOptions& options_;
  ThreadTeam threads_;
  int num_stages_;
  std::vector<Eigen::Index> rows_;  ///< first inequality of each stage, and their number
  StageKkt kkt_;

  StageVectors ux_, trial_ux_;
  Slacks slacks_;
  Eigen::VectorXd s_, ds_, lambda_, beta_, sigma_, residual_;
  std::vector<StageMultipliers> on_;
  Values values_, trial_;
  StageVectors dual_violation_, gradient_, weights_, right_equalities_, right_links_;
  StageVectors step_, step_on_equalities_, step_on_next_;
  Eigen::VectorXd no_next_;  ///< empty
  Eigen::VectorXd step_lambda_;

  double cost_scale_ = 1.0, mu_ = 0.0;
  bool is_linearised_anew_ = false;  ///< since the latest factorisation
  double regularisation_ = 0.0, last_regularisation_ = 0.0;
  int near_iterates_ = 0;  ///< feasible ones with an error not far above the tolerance
  bool has_barrier_fallen_ = false;
  double longest_ = 1.0;  ///< share of the latest step that the bounds allow
  double theta_ = 0.0, phi_ = 0.0, slope_ = 0.0, largest_dual_violation_ = 0.0;
  double least_theta_ = 0.0;  ///< below it only the barrier function decides on a step
  Filter filter_;
  /// Point before the first step without a filter.
  struct KeptPoint {
    StageVectors ux;
    Slacks slacks;
    Eigen::VectorXd lambda;
    std::vector<StageMultipliers> on;
    double mu, theta;
  };
  std::optional<KeptPoint> whole_steps_from_;
  IterateFigures figures_;
  int iterations_ = 0;
  std::string failure_;
  SolveTimes times_;
};

}  // namespace prowl
