#include "prowl/mpc/horizon_solver.hpp"

#include <gtest/gtest.h>

#include "tests/mpc/trot.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// Planned for until the plan hardly changes.
struct Settled : test::Trot {
  VectorXd q = program.standing_posture(), v = VectorXd::Zero(robot.nv());

  explicit Settled(int feedback_iterations) : Trot(0.0, {.feedback_iterations = feedback_iterations}) {
    program.use_hessian(options.hessian);
    for (int i = 0; i < 20; ++i) {
      EXPECT_TRUE(solver.prepare());
      EXPECT_TRUE(solver.step(q, v));
    }
  }
};

/// However many iterations its feedback may take: also the step that is not taken in full keeps what is linear.
TEST(HorizonSolver, StepsKeepDynamicsContinuityAndStart) {
  for (const int iterations : {1, 2, 3, 5}) {
    for (const double kick : {-0.3, 0.6}) {
      Settled settled(iterations);
      HorizonProgram& program = settled.program;
      const int stages = program.num_stages();
      ASSERT_TRUE(settled.solver.prepare());
      StageVectors step, equalities, links;
      for (int k = 0; k < stages; ++k) {
        step.push_back(-program.variables(k));
        equalities.push_back(program.equalities(k));
        links.push_back(program.link(k));
      }
      settled.v(1) += kick;
      if (!settled.solver.step(settled.q, settled.v)) {
        EXPECT_LT(iterations, 3) << "enough to solve it";
        continue;
      }
      EXPECT_EQ(settled.solver.step_share(), 1.0);
      if (iterations > 1) EXPECT_GT(settled.solver.iterations(), 1) << "a kick changes the active set";
      for (int k = 0; k < stages; ++k) step[k] += program.variables(k);
      for (int k = 0; k < stages; ++k) {
        equalities[k] += program.equality_slopes(k) * step[k];
        EXPECT_LT(equalities[k].lpNorm<Eigen::Infinity>(), 1e-9) << iterations << ' ' << kick << ' ' << k;
        if (k + 1 == stages) continue;
        VectorXd next, along;
        program.push_forward(k, step[k], next, along);
        const VectorXd error = links[k] + next - step[k + 1].tail(next.size());
        EXPECT_LT(error.lpNorm<Eigen::Infinity>(), 1e-9) << iterations << ' ' << kick << ' ' << k;
      }
      VectorXd q = settled.q, v = settled.v;
      program.get_state(0, q, v);
      EXPECT_LT((q - settled.q).norm() + (v - settled.v).norm(), 1e-9);
    }
  }
}

/// A failure moves no variable, and later plans find the same motion.
TEST(HorizonSolver, PreparesAfterAFailure) {
  Settled settled(5);
  ASSERT_TRUE(settled.solver.prepare());
  StageVectors before;
  for (int k = 0; k < settled.program.num_stages(); ++k) before.push_back(settled.program.variables(k));
  VectorXd fast = settled.v;
  fast(0) = 40.0;
  ASSERT_FALSE(settled.solver.step(settled.q, fast));
  for (int k = 0; k < settled.program.num_stages(); ++k) EXPECT_EQ(settled.program.variables(k), before[k]) << k;
  settled.solver.restart();
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(settled.solver.prepare()) << i;
    ASSERT_TRUE(settled.solver.step(settled.q, settled.v)) << i;
  }
  for (int k = 0; k < settled.program.num_stages(); ++k)
    EXPECT_LT((settled.program.variables(k) - before[k]).lpNorm<Eigen::Infinity>(), 1e-3) << k;
}

}  // namespace
}  // namespace prowl
