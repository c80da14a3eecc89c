#include "prowl/transcription/node_functions.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prowl/model/so3.hpp"
#include "prowl/transcription/independent_contacts.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/everything_problem.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

struct Case {
  std::string name;
  MotionProblem problem;
  int phase = 0;
};

RobotModel hyq_with_torque_curves() {
  RobotDescription description = test::hyq_description();
  description.limits["lf_kfe_joint"].torque_over_position = {
      {-2.5, 60.0}, {-1.8, 120.0}, {-1.2, 145.0}, {-0.6, 130.0}, {-0.3, 100.0}};
  description.limits["rh_hfe_joint"].torque_over_velocity = {{-20.0, 150.0}, {0.0, 140.0}, {5.0, 100.0}, {20.0, 20.0}};
  return RobotModel(description);
}

/// All that a node can have: free durations, contacts that open, land and swing, cones and pyramids, torque curves,
/// dependent contacts, flight.
std::vector<Case> cases() {
  std::vector<Case> result;
  MotionProblem steps = test::everything(
      hyq_with_torque_curves(), {test::free_phase("four", {0, 1, 2, 3}, 2), test::phase_on("lifted", {1, 2, 3}, 0.2, 2),
                                 test::free_phase("landed", {0, 1, 2, 3}, 2), test::phase_on("flight", {}, 0.2, 1)});
  steps.swing_clearance = 0.05;
  steps.surfaces.front().patch = {{-2.0, -2.0}, {2.0, -2.0}, {2.0, 2.0}, {-2.0, 2.0}};
  for (int phase = 0; phase < 4; ++phase) result.push_back({"steps", steps, phase});
  steps.friction_model = FrictionModel::pyramid;
  steps.running_cost.force_weight.setZero();
  result.push_back({"pyramid", steps, 2});
  const std::vector<int> corners = {0, 1, 2, 3, 4, 5, 6, 7};
  MotionProblem talos = test::everything(test::talos(), {test::phase_on("both feet", corners, 0.3, 2)});
  result.push_back({"talos", talos, 0});
  return result;
}

struct Node {
  NodeFunctions functions;
  NodePoint point;
  Eigen::VectorXd multipliers;
};

Node node_of(const Case& test, int k) {
  const MotionProblem& problem = test.problem;
  const ContactSchedule schedule(problem);
  NodeFunctions functions(problem, schedule, test.phase,
                          phase_contacts(problem, schedule, test.phase, problem.robot.nominal_configuration()));
  std::mt19937 rng(17);
  const DynamicsPoint at =
      test::random_point(problem.robot, functions.contacts(), rng, functions.chosen_rows().size());
  NodePoint point{.node = k, .q = at.q, .v = at.v, .a = at.a, .tau = at.tau, .w = at.chosen_forces,
                  .theta = {0.3, -0.2, 0.5}, .duration = 0.3, .anchors = at.anchors, .cost_weight = 0.1,
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
      EXPECT_EQ(hessian, expected) << test.name;
      EXPECT_EQ(hessian, hessian.transpose()) << test.name;
      EXPECT_GT(hessian.norm(), 0.0) << test.name;
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
    const auto expect_columns = [&](Eigen::VectorXd NodePoint::*member, Eigen::Index first, double step) {
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
