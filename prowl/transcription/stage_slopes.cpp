#include "prowl/transcription/stage_slopes.hpp"

namespace prowl {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void StageSlopes::push_forward(const VectorXd& step, VectorXd& next_step, VectorXd& inequalities) const {
  next_step.noalias() = next * step;
  inequalities.resize(num_inequalities());
  inequalities.head(rows.cols()).noalias() = rows.transpose() * step;
  inequalities.tail(bounds.cols()).noalias() = bounds.transpose() * step;
}

void StageSlopes::add_pull_back(const VectorXd& on_next, const VectorXd& on_inequalities, VectorXd& gradient) const {
  if (on_next.size() > 0) gradient.noalias() += next.transpose() * on_next;
  if (on_inequalities.size() == 0) return;
  gradient.noalias() += rows * on_inequalities.head(rows.cols());
  gradient.noalias() += bounds * on_inequalities.tail(bounds.cols());
}

void StageCondenser::add(const StageSlopes& stage, const MatrixXd& next_hessian, const VectorXd& weights,
                         MatrixXd& result) {
  if (stage.next.rows() > 0) {
    on_states_.resize(stage.next.rows(), stage.next.cols());
    kernels_.set_sparse(on_states_, next_hessian, stage.next);
    on_states_transposed_ = on_states_.transpose();
    kernels_.add_lower_sparse(result, on_states_transposed_, stage.next);
  }
  // Many rows have no bound, such as the friction of a foot in the air.
  const Index rows = stage.rows.cols();
  bounded_.resize(stage.rows.rows(), rows);
  weighted_.resize(stage.rows.rows(), rows);
  Index count = 0;
  for (Index i = 0; i < rows; ++i) {
    if (weights(i) == 0.0) continue;
    bounded_.col(count) = stage.rows.col(i);
    weighted_.col(count++) = weights(i) * stage.rows.col(i);
  }
  kernels_.add_lower(result, bounded_.leftCols(count), weighted_.leftCols(count));
  using Entry = Eigen::SparseMatrix<double>::InnerIterator;
  for (Index i = 0; i < stage.bounds.cols(); ++i) {
    for (Entry column(stage.bounds, i); column; ++column) {
      const double factor = weights(rows + i) * column.value();
      for (Entry row = column; row; ++row) result(row.row(), column.row()) += factor * row.value();
    }
  }
}

}  // namespace prowl
