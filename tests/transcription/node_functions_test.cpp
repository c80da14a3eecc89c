#include "prowl/transcription/node/node_functions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <regex>

#include "prowl/files/text_file.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/transcription/node/independent_contacts.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/everything_problem.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/terms_problem.hpp"

namespace prowl {
namespace {

struct Case {
  std::string name;
  DiscreteProblem discrete;
  int phase = 0;
};

RobotModel hyq_with_torque_curves() {
  RobotDescription description = test::hyq_description();
  description.urdf_text =
      std::regex_replace(read_text_file(description.urdf).text, std::regex("friction=\"0\""), "friction=\"2\"");
  description.limits["lf_kfe_joint"].torque_over_position = {
      {-2.5, 60.0}, {-1.8, 120.0}, {-1.2, 145.0}, {-0.6, 130.0}, {-0.3, 100.0}};
  description.limits["lf_kfe_joint"].negative_torque_over_position = {
      {-2.5, 40.0}, {-1.8, 70.0}, {-1.2, 90.0}, {-0.6, 80.0}, {-0.3, 60.0}};
  description.limits["rh_hfe_joint"].torque_over_velocity = {{-20.0, 150.0}, {0.0, 140.0}, {5.0, 100.0}, {20.0, 20.0}};
  return RobotModel(description);
}

/// All that a node can have: free durations, contacts that open, land and swing, cones and pyramids, torque curves,
/// dependent contacts, flight.
std::vector<Case> cases() {
  std::vector<Case> result;
  auto [steps, mesh] = test::everything(
      hyq_with_torque_curves(), {test::free_phase("four", {0, 1, 2, 3}, 2), test::phase_on("lifted", {1, 2, 3}, 0.2, 2),
                                 test::free_phase("landed", {0, 1, 2, 3}, 2), test::phase_on("flight", {}, 0.2, 1)});
  steps.swing_clearance = 0.05;
  steps.surfaces.front().patch = {{-2.0, -2.0}, {2.0, -2.0}, {2.0, 2.0}, {-2.0, 2.0}};
  for (int phase = 0; phase < 4; ++phase) result.push_back({"steps", {steps, mesh}, phase});
  steps.terms = test::every_term(steps.robot, "rf_foot", "lh_upperleg", 4);
  result.push_back({"terms", {steps, mesh}, 0});
  steps.terms.clear();
  steps.friction_model = FrictionModel::pyramid;
  steps.running_cost.force_weight.setZero();
  result.push_back({"pyramid", {steps, mesh}, 2});
  const std::vector<int> corners = {0, 1, 2, 3, 4, 5, 6, 7};
  const test::MeshedProblem talos = test::everything(test::talos(), {test::phase_on("both feet", corners, 0.3, 2)});
  result.push_back({"talos", talos.discrete(), 0});
  return result;
}

struct Node {
  NodeFunctions functions;
  NodePoint point;
  Eigen::VectorXd multipliers;
};

Node node_of(const Case& test, int k) {
  const RobotModel& robot = test.discrete.problem.robot;
  NodeFunctions functions(test.discrete, test.phase,
                          phase_contacts(test.discrete, test.phase, robot.nominal_configuration()));
  std::mt19937 rng(17);
  const DynamicsPoint at = test::random_point(robot, functions.contacts(), rng, functions.chosen_rows().size());
  NodePoint point{.node = k,
                  .q = at.q,
                  .v = at.v,
                  .a = at.a,
                  .tau = at.tau,
                  .w = at.chosen_forces,
                  .theta = {0.3, -0.2, 0.5},
                  .duration = 0.3,
                  .anchors = at.anchors,
                  .cost_weight = 0.1,
                  .terminal_weight = 1.0};
  const int rows = functions.num_rows(k);
  return {std::move(functions), std::move(point), test::random_vector(rng, rows, 1.0)};
}

TEST(NodeFunctions, LineariseIsAllTheOthersAtOnce) {
  for (const Case& test : cases()) {
    for (const int k : {0, 1}) {
      Node node = node_of(test, k), other = node_of(test, k);
      NodeValues all, values;
      Eigen::MatrixXd hessian, expected;
      node.functions.linearise(node.point, 1.7, node.multipliers, all, hessian);
      other.functions.hessian(node.point, 1.7, node.multipliers, expected);
      other.functions.evaluate(node.point, values);
      EXPECT_NEAR(all.cost, values.cost, 1e-12 * std::abs(values.cost)) << test.name;
      EXPECT_LT(test::relative_error(all.rows, values.rows), 1e-12) << test.name;
      EXPECT_LT(test::relative_error(all.forces, values.forces), 1e-12) << test.name;
      other.functions.evaluate_with_derivatives(node.point, values);
      EXPECT_EQ(all.cost_gradient, values.cost_gradient) << test.name;
      EXPECT_EQ(all.rows_jacobian, values.rows_jacobian) << test.name;
      const Eigen::MatrixXd symmetric = hessian.selfadjointView<Eigen::Lower>();
      EXPECT_EQ(symmetric, expected) << test.name;
      EXPECT_GT(symmetric.norm(), 0.0) << test.name;
    }
  }
}

// In velocities and all that comes after them variables are a vector space: the Hessian is the gradient's Jacobian.
TEST(NodeFunctions, HessianIsThatOfDifferencesOfTheGradient) {
  for (const Case& test : cases()) {
    Node node = node_of(test, 0);
    const Eigen::Index nv = node.point.v.size(), nu = node.point.tau.size();
    NodeValues values;
    Eigen::MatrixXd hessian;
    node.functions.hessian(node.point, 1.7, node.multipliers, hessian);
    const auto gradient = [&](const NodePoint& at) -> Eigen::VectorXd {
      node.functions.evaluate_with_derivatives(at, values);
      return 1.7 * values.cost_gradient + values.rows_jacobian.transpose() * node.multipliers;
    };
    const auto expect_columns = [&](Eigen::VectorXd NodePoint::* member, Eigen::Index first, double step) {
      Eigen::MatrixXd expected(hessian.rows(), (node.point.*member).size());
      for (Eigen::Index i = 0; i < expected.cols(); ++i) {
        NodePoint plus = node.point, minus = node.point;
        (plus.*member)(i) += step;
        (minus.*member)(i) -= step;
        expected.col(i) = (gradient(plus) - gradient(minus)) / (2.0 * step);
      }
      EXPECT_LT(test::relative_error(hessian.middleCols(first, expected.cols()), expected), 1e-6)
          << test.name << ", phase " << test.phase << ", column " << first;
    };
    expect_columns(&NodePoint::v, nv, 1e-5);
    expect_columns(&NodePoint::a, 2 * nv, 1e-4);
    expect_columns(&NodePoint::tau, 3 * nv, 1e-3);
    expect_columns(&NodePoint::w, 3 * nv + nu, 1e-3);
  }
}

/// Steps that shrink by any factor and grow by up to four, of two phases of random lengths.
std::vector<double> random_steps(std::mt19937& rng, int count) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::vector<double> steps = {0.01};
  while (std::ssize(steps) < count) {
    const double factor = part(rng) < 0.5 ? std::pow(20.0, -part(rng)) : std::pow(4.0, part(rng));
    steps.push_back(std::clamp(factor * steps.back(), 1e-4, 0.5));
  }
  return steps;
}

/// Gains (kd, kp) at each node of phases with these steps, half of them each.
std::vector<Eigen::Vector2d> gains_on(const std::vector<double>& steps) {
  const auto half = static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::vector<test::MeshedPhase> phases;
  for (const bool is_first : {true, false}) {
    const auto start = steps.begin() + (is_first ? 0 : half);
    const std::vector<double> of_phase(start, start + half);
    const double duration = std::accumulate(of_phase.begin(), of_phase.end(), 0.0);
    phases.push_back(is_first ? test::phase_on("first", {0, 1, 2, 3}, duration, 1)
                              : test::phase_on("second", {0, 1}, duration, 1));
    phases.back().mesh = PhaseMesh(of_phase);
  }
  const DiscreteProblem discrete = test::everything(test::hyq(), phases).discrete();
  std::vector<Eigen::Vector2d> gains;
  for (int p = 0; p < 2; ++p) {
    const NodeFunctions functions(discrete, p,
                                  phase_contacts(discrete, p, discrete.problem.robot.nominal_configuration()));
    for (int k = 0; k <= half; ++k) {
      gains.push_back(functions.gains({.node = k, .duration = discrete.problem.phases[p].duration.min}, 0));
    }
  }
  return gains;
}

/// The error x = (phi, phi_dot) of a contact goes by the trapezoid of phi_dot_dot = - kd phi_dot - kp phi. It neither
/// grows nor is pulled in faster than the steps that it comes from could, whatever steps follow.
TEST(NodeFunctions, GainsTakeAnErrorOfAContactDownOnAnyMesh) {
  std::mt19937 rng(23);
  const auto rate = [](const Eigen::Vector2d& gain) {
    Eigen::Matrix2d A;
    A << 0.0, 1.0, -gain(1), -gain(0);
    return A;
  };
  for (int mesh = 0; mesh < 20; ++mesh) {
    const std::vector<double> steps = random_steps(rng, 40);
    const std::vector<Eigen::Vector2d> gains = gains_on(steps);
    const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
    Eigen::Vector2d x(1.0, 0.0);
    std::size_t node = 0;
    for (std::size_t i = 0; i < steps.size(); ++i, ++node) {
      if (i == steps.size() / 2) ++node;  // the other side of the phase switch
      const Eigen::Matrix2d start = one + 0.5 * steps[i] * rate(gains[node]),
                            end = one - 0.5 * steps[i] * rate(gains[node + 1]);
      x = (end.inverse() * start * x).eval();
      EXPECT_LT(std::abs(x(0)), 0.81) << "mesh " << mesh << ", interval " << i;
      EXPECT_LT(std::abs(x(1)), 0.45 / steps[0]) << "mesh " << mesh << ", interval " << i;
    }
  }
}

#ifdef PROWL_COUNTS_ALLOCATIONS
TEST(NodeFunctions, AllocateNothingAfterTheFirstEvaluation) {
  const auto count = [](const auto& call) {
    const long before = test::allocations;
    call();
    return test::allocations - before;
  };
  const Eigen::VectorXd q = test::hyq().nominal_configuration();
  EXPECT_GT(count([&] { static_cast<void>(difference(q, q)); }), 0) << "allocations in Prowl's libraries go unseen";
  for (const Case& test : cases()) {
    for (const int k : {0, 1}) {
      Node node = node_of(test, k);
      NodeValues values;
      Eigen::MatrixXd hessian;
      const auto evaluate = [&] { node.functions.evaluate(node.point, values); };
      const auto differentiate = [&] { node.functions.evaluate_with_derivatives(node.point, values); };
      const auto linearise = [&] { node.functions.linearise(node.point, 1.7, node.multipliers, values, hessian); };
      linearise();
      node.point.q.tail(node.point.tau.size()).array() += 0.01;
      EXPECT_EQ(count(evaluate), 0) << test.name << ", phase " << test.phase << ", node " << k;
      EXPECT_EQ(count(differentiate), 0) << test.name << ", phase " << test.phase << ", node " << k;
      EXPECT_EQ(count(linearise), 0) << test.name << ", phase " << test.phase << ", node " << k;
    }
  }
}
#endif

}  // namespace
}  // namespace prowl
