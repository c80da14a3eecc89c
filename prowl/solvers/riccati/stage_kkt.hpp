#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>
#include <deque>
#include <vector>

#include "prowl/linear_algebra/matrix_kernels.hpp"
#include "prowl/nlp/linearised_chain.hpp"
#include "prowl/solvers/riccati/stage_vectors.hpp"

namespace prowl {

/// Newton's equations of a chain of stages, by a Riccati recursion: the step d_k = (du_k, dx_k) that minimises
///
///   sum of  1/2 d' M d + g' d,   M = Hessian of the Lagrangian + delta I + inequalities' diag(weights) inequalities
///   subject to  dx_{k+1} = next' d + b_k,   equalities' d + c_k = 0
///
/// for the latest linearisation of the stages, with the multipliers of both. From the last stage to
/// the first:
///
///   equalities     determine as many inputs as their rank, which are substituted. These are the
///                  first inputs (of a robot: its accelerations) where their square block is well
///                  conditioned; else full pivoting chooses, and the remainder is a condition on the
///                  state, E dx + e = 0, which becomes an equality of the stage before.
///   free inputs    minimise (Cholesky), which leaves the cost-to-go  1/2 dx' P dx + p' dx
///
/// Equalities that close the chain (StagewiseNlp::closure) are left out of the recursion. A dense system of their
/// multipliers, one solve of the chain a row, follows it. Then M may be indefinite along the open chain: the numbers of
/// negative eigenvalues of the free inputs and of that system show whether it is definite along the closed one.
///
/// The Cholesky factors exist if and only if M is positive definite on the null space of the
/// equalities. Dependent equalities are dropped, with zero multipliers. An input that could meet an
/// equality only by a huge step is not used: the equality goes to earlier stages, and iterative
/// refinement corrects the neglected part. No allocation while ranks stay the same.
class StageKkt {
 public:
  /// The states of the first stage are variables like its inputs (of a chain they are usually empty), or given: then
  /// dx_0 is that of set_states(), and the inputs of the first stage follow from it by a gain.
  enum class Start { free, given };

  /// A view of `chain`, which must outlive it.
  explicit StageKkt(LinearisedChain& chain, Start start = Start::free);

  enum class Hessian { lagrangian, identity };
  enum class Outcome { solvable, indefinite, not_finite };

  /// Factorises the equalities in the inputs that they determine. Call it after each linearisation of the stages; the
  /// factorisations after it differ in M alone.
  void determine_inputs();

  /// `weights`: of the inequalities, one vector per stage. With `identity` M omits the Hessian of
  /// the Lagrangian.
  Outcome factorise(Hessian hessian, double delta, const StageVectors& weights);
  /// The same for the first `stages` alone: the factors of the others, and with them the cost-to-go, stay. Only sweeps
  /// may follow, as refinement would take all of this for the whole chain's. Not for closed chains.
  Outcome factorise_first(int stages, Hessian hessian, double delta, const StageVectors& weights);
  int last_stage() const { return last_stage_; }    ///< stage where the latest factorisation ended; 0 if solvable
  int num_pivoted() const { return num_pivoted_; }  ///< stages whose determined inputs full pivoting chose

  /// Solves for g, c and b: one vector per stage, b without one for the last. `accuracy`: largest
  /// residual at which iterative refinement may stop.
  void solve(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links,
             double accuracy = 0.0);

  /// The two halves of solve(), without refinement, for chains that are not closed. sweep_back() begins at the last of
  /// the first `stages`; what the latest one left of the others stays.
  void sweep_back(int stages, const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links);
  /// Steps and multipliers of the stages from `begin` to before `end`, after those of all stages before.
  void sweep_ahead(int begin, int end, const StageVectors& links);

  /// dx_k from which the next sweep_ahead() begins there. dx_0 is also that of later solutions; zero before. Only with
  /// Start::given.
  void set_states(int k, const Eigen::Ref<const Eigen::VectorXd>& states) {
    steps_[static_cast<std::size_t>(k)].tail(states.size()) = states;
  }
  /// Of the latest factorisation: du_k = gain dx_k, besides what the right-hand sides add. `gain`: inputs x states of
  /// the stage. Not for closed chains.
  void input_gain(int k, Eigen::Ref<Eigen::MatrixXd> gain);

  const StageVectors& steps() const { return steps_; }
  const StageVectors& on_equalities() const { return on_equalities_; }
  const StageVectors& on_next() const { return on_next_; }
  const StageVectors& along_inequalities() const { return along_inequalities_; }  ///< their derivatives times the step

 private:
  /// Variables are ordered (determined inputs, free inputs, states); r: all but the determined
  /// ones. Kept small, as on long chains a solve reads it from main memory.
  struct Stage {
    StageSize size;
    int carried = 0;                            ///< conditions E of the next stage, equalities here
    int rank = 0;                               ///< number of determined inputs
    int passed = 0;                             ///< conditions E of this stage
    bool pivoted = false;                       ///< full pivoting chose the determined inputs
    bool has_finite_equalities = false;         ///< else nothing is determined
    std::vector<int> rows;                      ///< own and carried equalities; the first `rank` determine
    Eigen::MatrixXd lu;                         ///< their factors in the determined inputs, one row per equality
    Eigen::FullPivLU<Eigen::MatrixXd> full_lu;  ///< if pivoted
    std::vector<Eigen::Index> order;            ///< position of each variable in (u, x)
    Eigen::MatrixXd M_dd;                       ///< M in the determined inputs
    Eigen::MatrixXd K;                          ///< determined inputs = K' r + k
    Eigen::MatrixXd T;                          ///< M_rd + K M_dd
    Eigen::MatrixXd L;                          ///< Cholesky factor of N in the free inputs (lower triangle)
    Eigen::MatrixXd G;                          ///< N_xf L^-T
    Eigen::MatrixXd inverse_L;                  ///< of a closed chain: if N_ff is indefinite, N_ff = L diag(signs) L'
    Eigen::VectorXd signs;                      ///< then; else empty
    Eigen::MatrixXd P, E;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> conditions;  ///< of equalities that determine no input
    std::vector<int> passed_rows;                            ///< their indices among `rows` that form E

    Eigen::VectorXd m, c, k, r, p, e, step, on_rows, on_carried;
    Eigen::VectorXd gradient;
    int num_equalities() const { return size.equalities + carried; }
    int free() const { return size.inputs - rank; }
    int rest() const { return size.variables() - rank; }
  };

  /// Temporary matrices of a factorisation: one of each size, shared by all stages.
  class Shared {
   public:
    Eigen::MatrixXd& of_size(Eigen::Index rows, Eigen::Index cols);

   private:
    std::deque<Eigen::MatrixXd> matrices_;  ///< deque: references stay valid
  };
  struct Work {
    Shared equalities;  ///< own and carried ones, in (u, x)
    Shared in_states;   ///< L^-1 times those in x, rows in pivot order
    Shared condensed;   ///< M in (u, x)
    Shared M;           ///< in the stage's order
    Shared lu, K;       ///< of the first inputs, until it is known that they serve
  };

  Stage& stage(int k) { return stages_[k]; }
  const Eigen::MatrixXd& gather_equalities(int k);
  bool determine_first_inputs(Stage& stage, const Eigen::MatrixXd& equalities);
  void determine_any_inputs(Stage& stage, const Eigen::MatrixXd& equalities);
  void put_in_order(const Stage& stage, const Eigen::MatrixXd& condensed, Eigen::MatrixXd& M);
  void eliminate(Stage& stage, Eigen::MatrixXd& M);
  bool minimise(Stage& stage, const Eigen::Ref<const Eigen::MatrixXd>& N);
  bool make_stationary(Stage& stage, const Eigen::Ref<const Eigen::MatrixXd>& N);
  void pass_conditions(Stage& stage, const Eigen::MatrixXd& equalities, const Eigen::MatrixXd& in_states);
  /// Number of significant pivots of a stage's equalities; updates neglected_.
  template <class Pivots>
  int count_independent(const Eigen::MatrixXd& equalities, const Pivots& pivots);
  Outcome factorise_stage(int k);
  const Eigen::VectorXd* link_of(int k, const StageVectors& links) const {
    return k + 1 < num_stages_ ? &links[static_cast<std::size_t>(k)] : nullptr;
  }
  void backward(int k, const Eigen::VectorXd& gradient, const Eigen::VectorXd& equalities, const Eigen::VectorXd* link);
  void forward(int k, const Eigen::VectorXd* link);
  void find_multipliers(int k);
  double left_out() const;
  void solve_once(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links);
  void solve_chain(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links);
  Eigen::Index num_closing() const { return chain_.closure().rows(); }
  Eigen::VectorXd along_closure() const;  ///< derivative of the closing equalities times the step
  void pull_back_closure(const Eigen::VectorXd& multipliers, StageVectors& gradient) const;
  bool factorise_closure();
  double find_residual(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links);

  LinearisedChain& chain_;
  MatrixKernels kernels_;
  int num_stages_;
  std::vector<Stage> stages_;
  Work work_;
  StageVectors steps_, on_equalities_, on_next_, along_inequalities_;
  int last_stage_ = 0, num_pivoted_ = 0;
  double neglected_ = 0.0;  ///< largest coefficient that was left out of an equality; 0 if only rounding was
  Hessian hessian_ = Hessian::lagrangian;
  double delta_ = 0.0;
  StageVectors weights_;
  struct Solution {
    StageVectors steps, on_equalities, on_next, along_inequalities;
  } sum_;
  StageVectors residual_gradient_, residual_equalities_, residual_links_, residual_next_, residual_inequalities_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> closing_;  ///< minus the closing equalities over multipliers
  int num_negative_ = 0;  ///< negative curvatures of the chain, which its closing equalities must exclude
  Eigen::MatrixXd no_hessian_;
  Eigen::VectorXd nothing_;                      ///< no multipliers
  Eigen::MatrixXd free_gain_, determined_gain_;  ///< work space of input_gain()
};

}  // namespace prowl
