#include "prowl/feasibility/standing_load.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/nlp/stored_nlp.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kEdges = 16;
constexpr double kMostOfAnEdge = 10.0;  // [weights]; bounds feet that press against each other

/// minimise cost . z  subject to bounds on z and rows z.
class LinearProgram : public StoredNlp {
 public:
  LinearProgram(VectorXd slope, MatrixXd rows, VectorXd z_lower, VectorXd z_upper, VectorXd g_lower, VectorXd g_upper)
      : slope_(std::move(slope)), rows_(std::move(rows)) {
    variable_lower_ = std::move(z_lower);
    variable_upper_ = std::move(z_upper);
    constraint_lower_ = std::move(g_lower);
    constraint_upper_ = std::move(g_upper);
    for (int row = 0; row < num_constraints(); ++row) {
      for (int col = 0; col < num_variables(); ++col) {
        jacobian_pattern_.rows.push_back(row);
        jacobian_pattern_.cols.push_back(col);
      }
    }
  }

  double cost(const VectorXd& z) override { return slope_.dot(z); }
  void cost_gradient(const VectorXd&, Eigen::Ref<VectorXd> gradient) override { gradient = slope_; }
  void constraints(const VectorXd& z, Eigen::Ref<VectorXd> g) override { g = rows_ * z; }
  void jacobian(const VectorXd&, Eigen::Ref<VectorXd> values) override {
    values = rows_.transpose().reshaped();  // row by row
  }
  void hessian(const VectorXd&, double, const VectorXd&, Eigen::Ref<VectorXd>) override {}

  std::string describe_constraint(int row) const override { return "row " + std::to_string(row); }
  std::string describe_variable(int index) const override { return "variable " + std::to_string(index); }

 private:
  VectorXd slope_;
  MatrixXd rows_;
};

/// Edges of a pyramid around the friction cone, as columns, each with a normal component of 1.
Eigen::Matrix<double, 3, kEdges> edges_around_cone(const Surface& surface) {
  const double mu = surface.friction / std::cos(std::numbers::pi / kEdges);
  Eigen::Matrix<double, 3, kEdges> edges;
  for (int i = 0; i < kEdges; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kEdges;
    edges.col(i) = surface.normal + mu * surface.axes() * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  return edges;
}

}  // namespace

StandingLoad standing_load(const MotionProblem& problem, const VectorXd& q, const std::vector<PhaseContact>& contacts,
                           const NlpSolver& solver) {
  const RobotModel& robot = problem.robot;
  const int nu = robot.nu();
  const VectorXd rest = VectorXd::Zero(robot.nv());
  RigidBodyTerms terms(robot);
  terms.update(q, rest, rest);
  ContactKinematics kinematics(contact_indices(contacts));
  kinematics.set_configuration(terms);
  const VectorXd gravity = terms.inverse_dynamics() / robot.weight();

  // Variables: the share of the weight, then the forces along the edges, in weights. Rows: s g - J' f, the unbalanced
  // force on the base (zero) and the joint torques, over the weight.
  MatrixXd rows(robot.nv(), 1 + kEdges * static_cast<Index>(contacts.size()));
  rows.col(0) = gravity;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Surface& surface = problem.surfaces[contacts[c].surface];
    rows.middleCols(1 + kEdges * static_cast<Index>(c), kEdges) =
        -kinematics.jacobian().middleRows<3>(static_cast<Index>(3 * c)).transpose() * edges_around_cone(surface);
  }
  VectorXd lower = VectorXd::Zero(robot.nv()), upper = lower;
  for (int j = 0; j < nu; ++j) {
    lower(6 + j) = robot.torque_lower(j, q(7 + j), 0.0) / robot.weight();
    upper(6 + j) = robot.torque_upper(j, q(7 + j), 0.0) / robot.weight();
  }
  VectorXd most = VectorXd::Constant(rows.cols(), kMostOfAnEdge);
  most(0) = 1.0;
  LinearProgram program(-VectorXd::Unit(rows.cols(), 0), rows, VectorXd::Zero(rows.cols()), most, lower, upper);

  SolverOptions options;
  options.tolerance = 1e-8;
  const SolveResult result = solver.solve(program, VectorXd::Constant(rows.cols(), 0.5 / kEdges), options);
  StandingLoad load;
  load.solved = result.status == SolveStatus::converged;
  if (!load.solved) return load;
  load.share = result.z(0);
  if (load.share > 1e-6) load.torque_needed = robot.weight() / load.share * (rows * result.z).tail(nu);
  return load;
}

}  // namespace prowl
