#include "prowl/transcription/congruence.hpp"

namespace prowl {

namespace {

using Eigen::Dynamic;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;

template <class Block>
void mirror(Block&& block) {
  block.template triangularView<Eigen::StrictlyUpper>() = block.transpose();
}

}  // namespace

void add_multiple(MatrixXd& m, Index from, Index to, Index count, double factor) {
  const Index end = from + count, after = to + count, below = m.rows() - after;
  auto own = m.block(from, from, count, count), cross = m.block(to, from, count, count);
  mirror(own);
  m.block(to, 0, count, from) += factor * m.block(from, 0, count, from);
  m.block(to, end, count, to - end) += factor * m.block(end, from, to - end, count).transpose();
  m.block(to, to, count, count) += factor * (cross + cross.transpose()) + factor * factor * own;
  cross += factor * own;
  m.block(after, to, below, count) += factor * m.block(after, from, below, count);
}

void add_vector(MatrixXd& m, Index from, Index to, double factor, const Eigen::Ref<const Eigen::VectorXd>& x) {
  const Index count = x.size(), end = from + count, below = m.rows() - to - 1;
  auto own = m.block(from, from, count, count);
  mirror(own);
  auto row = m.row(to).head(to);
  auto change = m.col(to).head(to);  // of the row: room that is undefined anyway
  change.head(from).noalias() = factor * m.block(from, 0, count, from).transpose() * x;
  change.segment(from, count).noalias() = factor * own * x;
  change.tail(to - end).noalias() = factor * m.block(end, from, to - end, count) * x;
  m(to, to) += factor * (2.0 * row.segment(from, count).transpose() + change.segment(from, count)).dot(x);
  row += change.transpose();
  m.col(to).tail(below).noalias() += factor * m.block(to + 1, from, below, count) * x;
}

void add_block(MatrixXd& m, Index from, Index to, const Matrix3d& by) {
  const Index end = from + 3, after = to + 3, below = m.rows() - after;
  auto own = m.block<3, 3>(from, from), cross = m.block<3, 3>(to, from);
  mirror(own);
  m.middleRows<3>(to).leftCols(from) += by.transpose().lazyProduct(m.middleRows<3>(from).leftCols(from));
  m.middleRows<3>(to).middleCols(end, to - end) +=
      by.transpose().lazyProduct(m.middleCols<3>(from).middleRows(end, to - end).transpose());
  const Matrix3d half = cross * by + 0.5 * (by.transpose() * own * by);
  m.block<3, 3>(to, to) += half + half.transpose();
  cross += by.transpose() * own;
  m.middleCols<3>(to).bottomRows(below) += m.middleCols<3>(from).bottomRows(below).lazyProduct(by);
}

void replace_block(MatrixXd& m, Index at, const Matrix3d& by) {
  auto own = m.block<3, 3>(at, at);
  mirror(own);
  for (Index column = 0; column < at; ++column) {
    m.col(column).segment<3>(at) = (by.transpose() * m.col(column).segment<3>(at)).eval();
  }
  own = (by.transpose() * own * by).eval();
  for (Index row = at + 3; row < m.rows(); ++row) {
    m.row(row).segment<3>(at) = (m.row(row).segment<3>(at) * by).eval();
  }
}

}  // namespace prowl
