#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>
#include <vector>

#include "prowl/nlp/stagewise_nlp.hpp"

namespace prowl {

/// One vector a stage.
using StageVectors = std::vector<Eigen::VectorXd>;

/// Newton's equations of a chain of stages, by a Riccati recursion: the step (du_k, dx_k) that minimises
///
///   sum of  1/2 d' M d + g' d,   M = Hessian of the Lagrangian + delta I + inequalities' diag(weights) inequalities
///   subject to  dx_{k+1} = next' d + b_k,   equalities' d + c_k = 0
///
/// at the stages as they were linearised last, with the multipliers of both. From the last stage to the first:
///
///   determined inputs    follow from the equalities that determine them (LU), and are substituted
///   other equalities     take away as many inputs as their rank (QR with pivoting); what is left of them is a condition on
///                        the state, which goes to the stage before as an equality of its own, E dx + e = 0
///   free inputs          minimise (Cholesky): the cost-to-go  1/2 dx' P dx + p' dx
///
/// The Cholesky factors exist if and only if M is positive definite on the steps that keep the equalities. Equalities
/// that depend on others are left out, with multipliers of zero. All memory is taken at construction.
class StageKkt {
 public:
  /// A view of `nlp`, which must outlive it.
  explicit StageKkt(StagewiseNlp& nlp);

  enum class Hessian { lagrangian, identity };
  enum class Outcome { solvable, indefinite, not_finite };

  /// `weights`: of the inequalities. With `identity` M is delta I and the weighted inequalities.
  Outcome factorise(Hessian hessian, double delta, const StageVectors& weights);

  /// Of g, c and b, one vector a stage each; b has none after the last stage.
  void solve(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links);

  const StageVectors& steps() const { return steps_; }
  const StageVectors& on_equalities() const { return on_equalities_; }
  const StageVectors& on_next() const { return on_next_; }
  const StageVectors& along_inequalities() const { return along_inequalities_; }  ///< their derivatives times the step

 private:
  /// r = (inputs that are not determined, states); y = Q' of those inputs, y1 the first `rank` of them.
  struct Stage {
    StageSize size;
    int carried = 0;      ///< conditions E of the next stage
    int rank = 0;         ///< of the other equalities, in the inputs that are not determined
    int passed = 0;       ///< conditions E of this stage
    Eigen::MatrixXd M;    ///< (u, x)
    Eigen::PartialPivLU<Eigen::MatrixXd> determining;
    Eigen::MatrixXd K;    ///< determined inputs = K r + k
    Eigen::MatrixXd T;    ///< M_dd K + M_dr
    Eigen::MatrixXd others;  ///< other equalities, then those carried, in (u, x)
    Eigen::MatrixXd reduced; ///< the same in r, determined inputs substituted
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> range;  ///< of the transposed reduced others, in the inputs
    Eigen::MatrixXd Q;
    Eigen::MatrixXd Y;    ///< y1 = Y dx + ...
    Eigen::MatrixXd N;    ///< M in (y, x), determined inputs substituted
    Eigen::MatrixXd S;    ///< N_x1 + Y' N_11
    Eigen::LLT<Eigen::MatrixXd> cholesky;
    Eigen::MatrixXd G;    ///< L^-1 N_fx of the free inputs
    Eigen::MatrixXd P;    ///< cost-to-go
    Eigen::MatrixXd E;    ///< conditions on the state, the first `passed` rows
    std::vector<int> passed_rows;  ///< which of the other equalities they are

    Eigen::VectorXd m, k, p, e, c, c_y, y, on_others, on_carried;
    int determined() const { return size.determined; }
    int rest() const { return size.inputs - size.determined; }
    int free() const { return rest() - rank; }
    int num_others() const { return size.equalities - size.determined + carried; }
  };

  Stage& stage(int k) { return stages_[static_cast<std::size_t>(k)]; }
  bool factorise_stage(int k, Hessian hessian, double delta, const Eigen::VectorXd& weights);
  void eliminate_determined(Stage& stage);
  void eliminate_others(Stage& stage);
  void backward(int k, const Eigen::VectorXd& gradient, const Eigen::VectorXd& equalities, const Eigen::VectorXd* link);
  void forward(int k, const Eigen::VectorXd* link);

  StagewiseNlp& nlp_;
  int num_stages_;
  std::vector<Stage> stages_;
  StageVectors steps_, on_equalities_, on_next_, along_inequalities_;
  Eigen::MatrixXd no_hessian_, work_;
  Eigen::VectorXd unused_;
};

}  // namespace prowl
