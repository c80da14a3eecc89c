#include "alternatives/collocation/rules/interval_program.hpp"

#include "alternatives/collocation/graph/rate_function.hpp"

namespace prowl {

std::vector<int> rows_of_every_instant(const ChartedNode& node, bool eliminates_acceleration) {
  std::vector<int> rows;
  for (int row = eliminates_acceleration ? node.num_dofs() : 0; row < node.functions().placement_row(0); ++row) {
    rows.push_back(row);
  }
  const int contact_rows = node.functions().num_rows(0);
  for (int row = node.contact_rows().first_acceleration(); row < node.contact_rows().count(); ++row) {
    rows.push_back(contact_rows + row);
  }
  return rows;
}

IntervalProgram::Point IntervalProgram::evaluated(Point point, double cost_share, bool with_rows) {
  ProgramGraph& graph = piece_.graph;
  RateFunction& rate = piece_.own(std::make_unique<RateFunction>(node_.chart(), node_.num_dofs()));
  point.rate = graph.call(rate, {point.x, point.v});

  // Node 0 of the phase: nothing opens there.
  const bool eliminates = dynamics_.eliminates_acceleration();
  const std::vector<int> rows = with_rows ? rows_of_every_instant(node_, eliminates) : std::vector<int>{};
  PointFunction& dynamics = piece_.own(dynamics_.at(node_, {.node = 0, .cost_share = cost_share}, rows));
  std::vector<Vector> inputs = {point.x, point.v};
  if (!eliminates) inputs.push_back(point.acceleration);
  inputs.insert(inputs.end(), {point.tau, point.w, shared_});
  const Vector all = graph.call(dynamics, inputs);
  if (eliminates) point.acceleration = graph.slice(all, 0, node_.num_dofs());
  if (cost_share > 0.0) piece_.add_cost(graph.slice(all, dynamics.num_outputs() - 1, 1));
  if (rows.empty()) return point;

  const auto size = static_cast<Eigen::Index>(rows.size());
  ProgramPiece::Rows held{graph.slice(all, dynamics.acceleration_size(), static_cast<int>(size)),
                          Eigen::VectorXd::Zero(size),
                          Eigen::VectorXd::Zero(size),
                          {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    held.upper(static_cast<Eigen::Index>(i)) = node_.upper(0, rows[i]);
    held.names.push_back(node_.describe_row(0, rows[i]) + " in the interval");
  }
  piece_.add_rows(std::move(held));
  return point;
}

void IntervalProgram::equal_zero(Vector vector, const std::string& what) {
  const int size = piece_.graph.size(vector);
  ProgramPiece::Rows rows{vector, Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size), {}};
  for (int i = 0; i < size; ++i) rows.names.push_back(node_.describe_coordinate(i) + ", " + what);
  piece_.add_rows(std::move(rows));
}

}  // namespace prowl
