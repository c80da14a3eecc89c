#pragma once

#include <vector>

#include "alternatives/collocation/dynamics/dynamics_form.hpp"
#include "alternatives/collocation/graph/program_piece.hpp"

namespace prowl {

/// One interval of the mesh, for a rule to write its equations into.
class IntervalProgram {
 public:
  using Vector = ProgramGraph::Vector;
  using Term = ProgramGraph::Term;

  /// State, its rates ẋ and v̇, and torques at an end; w: forces that are variables.
  struct Point {
    Vector x, v, rate, acceleration, tau, w;
  };
  Point left, right;
  /// The variables in the middle, those that the rule has asked for.
  Point middle;

  IntervalProgram(ProgramPiece& piece, ChartedNode& node, const DynamicsForm& dynamics, Vector shared)
      : piece_(piece), node_(node), dynamics_(dynamics), shared_(shared) {}

  Vector sum(std::vector<Term> terms) { return piece_.graph.sum(std::move(terms)); }

  /// Rates at a point inside, whose x, v, tau, w (and acceleration, where it is a variable) are given. The running cost
  /// there counts with `cost_share` of the step; what holds at every instant holds there too, if `with_rows`.
  Point evaluated(Point point, double cost_share, bool with_rows);

  /// vector = 0; `what` for messages, e.g. "position".
  void equal_zero(Vector vector, const std::string& what);

 private:
  ProgramPiece& piece_;
  ChartedNode& node_;
  const DynamicsForm& dynamics_;
  Vector shared_;
};

/// Rows of ChartedNode that hold at every instant, not at nodes only: dynamics (where they are rows), friction, torque
/// limits, and accelerations of contacts.
std::vector<int> rows_of_every_instant(const ChartedNode& node, bool eliminates_acceleration);

}  // namespace prowl
