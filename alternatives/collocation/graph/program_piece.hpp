#pragma once

#include <memory>
#include <string>
#include <vector>

#include "alternatives/collocation/graph/program_graph.hpp"

namespace prowl {

/// A graph as part of a nonlinear program: maps locals to decision variables, and vectors to rows
/// and costs.
class ProgramPiece {
 public:
  /// `columns`: decision variable of each local.
  ProgramPiece(std::vector<int> columns, const StepSize& step)
      : graph(static_cast<int>(columns.size()), step), columns_(std::move(columns)) {}

  ProgramGraph graph;

  struct Rows {
    ProgramGraph::Vector vector;
    Eigen::VectorXd lower, upper;
    std::vector<std::string> names;
    int first = 0;  ///< row in the program, set later
  };
  void add_rows(Rows rows) { rows_.push_back(std::move(rows)); }
  void add_cost(ProgramGraph::Vector scalar) { costs_.push_back(scalar); }
  /// Takes ownership of a function of the graph.
  template <class F>
  F& own(std::unique_ptr<F> function) {
    F& kept = *function;
    functions_.push_back(std::move(function));
    return kept;
  }

  const std::vector<int>& columns() const { return columns_; }
  std::vector<Rows>& rows() { return rows_; }
  const std::vector<Rows>& rows() const { return rows_; }
  const std::vector<ProgramGraph::Vector>& costs() const { return costs_; }

  /// Calls emit(row, col, value) for each entry of the Jacobian, in a fixed order.
  template <class Emit>
  void visit_jacobian(bool pattern_only, Emit emit) const {
    for (const Rows& rows : rows_) {
      const ProgramGraph::Pattern& pattern = graph.pattern(rows.vector);
      for (int i = 0; i < pattern.rows(); ++i) {
        for (int j = 0; j < pattern.cols(); ++j) {
          if (pattern(i, j) == 0.0F) continue;
          emit(rows.first + i, columns_[j], pattern_only ? 0.0 : graph.derivative(rows.vector)(i, j));
        }
      }
    }
  }

 private:
  std::vector<int> columns_;
  std::vector<Rows> rows_;
  std::vector<ProgramGraph::Vector> costs_;
  std::vector<std::unique_ptr<DifferentiableFunction>> functions_;
};

}  // namespace prowl
