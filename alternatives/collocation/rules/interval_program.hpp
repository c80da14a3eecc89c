#pragma once

#include <vector>

#include "alternatives/collocation/dynamics/dynamics_form.hpp"
#include "alternatives/collocation/graph/program_piece.hpp"

namespace prowl {

/// One mesh interval, to which a rule adds its equations.
class IntervalProgram {
 public:
  using Vector = ProgramGraph::Vector;
  using Term = ProgramGraph::Term;

  /// State, rates ẋ and v̇, and torques at a point; w: forces, if variables.
  struct Point {
    Vector x, v, rate, acceleration, tau, w;
  };
  Point left, right;
  /// Variables in the middle, as requested by the rule.
  Point middle;

  IntervalProgram(ProgramPiece& piece, ChartedNode& node, const DynamicsForm& dynamics, Vector shared)
      : piece_(piece), node_(node), dynamics_(dynamics), shared_(shared) {}

  Vector sum(std::vector<Term> terms) { return piece_.graph.sum(std::move(terms)); }

  /// Evaluates rates at an inner point with given x, v, tau, w (and acceleration, if a variable).
  /// `cost_share`: quadrature weight of the running cost there; `with_rows`: add
  /// rows_of_every_instant().
  Point evaluated(Point point, double cost_share, bool with_rows);

  /// vector = 0; `what` for messages, e.g. "position".
  void equal_zero(Vector vector, const std::string& what);

 private:
  ProgramPiece& piece_;
  ChartedNode& node_;
  const DynamicsForm& dynamics_;
  Vector shared_;
};

/// Rows of ChartedNode that hold at every instant, not only at nodes: dynamics (if rows), friction,
/// torque limits, and accelerations of contacts.
std::vector<int> rows_of_every_instant(const ChartedNode& node, bool eliminates_acceleration);

}  // namespace prowl
