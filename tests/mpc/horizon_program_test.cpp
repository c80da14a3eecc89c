#include "prowl/mpc/horizon_program.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "prowl/model/configuration.hpp"
#include "prowl/mpc/standing_robot.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSteps = 3;

/// A horizon about the standing posture, with other feet on the ground in each step.
void fill(HorizonProgram& program, std::mt19937& rng) {
  const RobotModel& robot = program.robot();
  const auto random = [&](int size, double most) { return test::random_vector(rng, size, most); };
  const unsigned all = (1U << program.num_feet()) - 1U;
  for (int k = 0; k < kSteps; ++k) {
    const VectorXd q = integrate(program.standing_posture(), random(robot.nv(), 0.1));
    program.set_stage(k, q, random(robot.nv(), 0.5), random(robot.nv(), 2.0), random(robot.nu(), 20.0));
    program.variables(k) += random(static_cast<int>(program.variables(k).size()), 0.05);
    HorizonStep& step = program.step(k);
    step.length = 0.03;
    step.contact_time = 0.02;
    step.standing = k == 0 ? all : k == 1 ? 1U : 0U;
    step.q_ref = integrate(program.standing_posture(), random(robot.nv(), 0.1));
    step.v_ref = random(robot.nv(), 0.2);
  }
  for (int k = 0; k < kSteps; ++k) program.linearise(k);
}

double largest(const MatrixXd& matrix) { return matrix.size() > 0 ? matrix.cwiseAbs().maxCoeff() : 0.0; }

class EachRobot : public testing::TestWithParam<RobotDescription (*)()> {};

TEST_P(EachRobot, DerivativesAreThoseOfTheValues) {
  HorizonProgram program(RobotModel{GetParam()()}, MpcWeights{}, 0.6, kSteps);
  std::mt19937 rng(3);
  fill(program, rng);
  for (int k = 0; k < kSteps; ++k) {
    const StageSize& size = program.size(k);
    const int next = k + 1 < kSteps ? size.states : 0;
    MatrixXd equalities(size.equalities, size.variables()), inequalities(size.inequalities, size.variables()),
        links(next, size.variables());
    MatrixXd d_inequalities = inequalities, d_links = links;
    VectorXd gradient(size.variables());
    const MatrixXd d_equalities = program.equality_slopes(k);
    const VectorXd d_cost = program.cost_gradient(k);
    for (int j = 0; j < size.variables(); ++j) {
      VectorXd along_next(next), along_rows;
      program.push_forward(k, VectorXd::Unit(size.variables(), j), along_next, along_rows);
      d_inequalities.col(j) = along_rows;
      d_links.col(j) = along_next;
    }
    for (int j = 0; j < size.variables(); ++j) {
      constexpr double kStep = 1e-5;
      double& variable = program.variables(k)(j);
      const double at = variable;
      variable = at + kStep;
      program.linearise(k);
      equalities.col(j) = program.equalities(k);
      inequalities.col(j) = program.inequalities(k);
      links.col(j) = program.link(k);
      gradient(j) = program.cost(k);
      variable = at - kStep;
      program.linearise(k);
      equalities.col(j) = (equalities.col(j) - program.equalities(k)) / (2.0 * kStep);
      inequalities.col(j) = (inequalities.col(j) - program.inequalities(k)) / (2.0 * kStep);
      links.col(j) = (links.col(j) - program.link(k)) / (2.0 * kStep);
      gradient(j) = (gradient(j) - program.cost(k)) / (2.0 * kStep);
      variable = at;
    }
    EXPECT_LT(largest(d_equalities - equalities), 1e-8) << k;
    EXPECT_LT(largest(d_inequalities - inequalities), 1e-8 * (1.0 + largest(d_inequalities))) << k;
    EXPECT_LT(largest(d_links - links), 1e-8) << k;
    EXPECT_LT(largest(d_cost - gradient), 1e-8) << k;
  }
}

TEST_P(EachRobot, HessianIsThatOfTheLagrangian) {
  HorizonProgram program(RobotModel{GetParam()()}, MpcWeights{}, 0.6, kSteps);
  std::mt19937 rng(5);
  fill(program, rng);
  for (int k = 0; k < kSteps; ++k) {
    StageMultipliers& on = program.multipliers(k);
    for (VectorXd* multipliers : {&on.equalities, &on.inequalities, &on.next})
      *multipliers = test::random_vector(rng, static_cast<int>(multipliers->size()), 1.0);
    const auto gradient = [&] {
      program.linearise(k);
      VectorXd result = program.cost_gradient(k) + program.equality_slopes(k).transpose() * on.equalities;
      program.add_pull_back(k, on.next, on.inequalities, result);
      return result;
    };
    program.linearise(k);
    const MatrixXd hessian = program.lagrangian_hessian(k).selfadjointView<Eigen::Lower>();
    MatrixXd expected(hessian.rows(), hessian.cols());
    for (Eigen::Index j = 0; j < hessian.cols(); ++j) {
      constexpr double kStep = 1e-5;
      double& variable = program.variables(k)(j);
      const double at = variable;
      variable = at + kStep;
      expected.col(j) = gradient();
      variable = at - kStep;
      expected.col(j) = (expected.col(j) - gradient()) / (2.0 * kStep);
      variable = at;
      // Forces of contacts that other sets have change nothing. They only have to stay determined.
      if (largest(expected.col(j)) > 0.0) continue;
      EXPECT_GE(j, program.robot().nv() + program.robot().nu());
      EXPECT_GT(hessian(j, j), 0.0);
      expected(j, j) = hessian(j, j);
    }
    EXPECT_LT(largest(hessian - expected), 1e-6 * largest(expected)) << k;
  }
}

TEST_P(EachRobot, StateAndInputsComeBack) {
  HorizonProgram program(RobotModel{GetParam()()}, MpcWeights{}, 0.6, kSteps);
  std::mt19937 rng(4);
  const RobotModel& robot = program.robot();
  const VectorXd q = integrate(program.standing_posture(), test::random_vector(rng, robot.nv(), 0.5));
  const VectorXd v = test::random_vector(rng, robot.nv(), 1.0), a = test::random_vector(rng, robot.nv(), 5.0),
                 tau = test::random_vector(rng, robot.nu(), 30.0);
  program.set_stage(1, q, v, a, tau);
  VectorXd q_back = q, v_back, a_back, tau_back, states;
  program.get_state(1, q_back, v_back);
  program.get_inputs(1, a_back, tau_back);
  EXPECT_LT(difference(q, q_back).norm(), 1e-12);
  EXPECT_LT((v - v_back).norm(), 1e-12);
  EXPECT_LT((a - a_back).norm(), 1e-12);
  EXPECT_LT((tau - tau_back).norm(), 1e-10);
  program.to_states(1, q, v, states);
  EXPECT_LT((states - program.variables(1).tail(states.size())).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(HorizonProgram, EachRobot,
                         testing::Values(&test::hyq_description, &test::anymal_c_description,
                                         &test::talos_description));

TEST(HorizonProgram, FeetAreTheBodiesThatCarryContacts) {
  EXPECT_EQ(contacts_of_feet(RobotModel(test::hyq_description())).size(), 4U);
  const auto talos = contacts_of_feet(RobotModel(test::talos_description()));
  ASSERT_EQ(talos.size(), 2U);
  EXPECT_EQ(talos[0].size(), 4U);
}

/// Of flat feet, some contact forces follow from others. Which ones must not depend on where the robot heads.
TEST_P(EachRobot, StandsInEachHeading) {
  const RobotModel robot{GetParam()()};
  HorizonProgram program(robot, MpcWeights{}, 0.6, kSteps);
  const VectorXd still = VectorXd::Zero(robot.nv());
  for (const double turned : {0.0, 0.7, 1.5707963267948966, -1.5, 3.0}) {
    VectorXd q = program.standing_posture();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    q.head<3>() = turn * q.head<3>();
    set_base_rotation(q, turn * base_rotation(q));
    const MpcPlan::Step held = standing_step(robot, program.feet(), q);
    for (int k = 0; k < kSteps; ++k) {
      program.set_stage(k, q, still, still, held.tau);
      program.step(k).length = 0.03;
      program.step(k).contact_time = 0.02;
      program.step(k).standing = held.standing;
    }
    program.linearise(0);
    EXPECT_LT(largest(program.equalities(0)), 1e-6) << turned;
    EXPECT_LT(largest(program.equality_slopes(0)), 1e3) << turned;
    Eigen::Vector3d total = Eigen::Vector3d::Zero();
    for (Eigen::Index c = 0; c < program.forces(0).size(); c += 3) total += program.forces(0).segment<3>(c);
    EXPECT_LT((total / robot.weight() - Eigen::Vector3d::UnitZ()).norm(), 1e-6) << turned;
    EXPECT_LT(largest(program.forces(0)), robot.weight()) << turned;
  }
}

}  // namespace
}  // namespace prowl
