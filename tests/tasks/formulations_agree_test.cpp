// All whole-body formulations find the same motion of HyQ's crouch, each on a mesh that its rule needs to pass the
// certificate.
#include <gtest/gtest.h>

#include "alternatives/run_formulation.hpp"
#include "prowl/guess/initial_guess.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

FormulationRun crouch(const Formulation& formulation, int intervals) {
  const std::string file = std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/crouch.toml";
  const Task task = read_task_file(file, test::test_search(), {.intervals = intervals});
  return run_formulation({task.problem, task.mesh}, formulation, IpoptSolver(), task.solver);
}

void expect_agreement(const Formulation& formulation, int intervals, double cost) {
  SCOPED_TRACE(formulation.dynamics + ", " + formulation.transcription + ", " + formulation.orientation);
  const FormulationRun run = crouch(formulation, intervals);
  ASSERT_EQ(run.result.status, SolveStatus::converged) << run.result.message;
  EXPECT_NE(run.certificate.grade, CertificateGrade::failed) << run.worst_check()->name;
  EXPECT_NEAR(run.result.cost, cost, 0.01 * cost);
}

TEST(FormulationsAgree, OnTheCostOfCrouchAndPassTheCertificate) {
  const FormulationRun fine = crouch({.transcription = "hermite-simpson-separated"}, 40);
  ASSERT_EQ(fine.result.status, SolveStatus::converged) << fine.result.message;
  for (const std::string dynamics : {"inverse", "forward", "kkt"}) {
    expect_agreement({.dynamics = dynamics}, 80, fine.result.cost);
    expect_agreement({.dynamics = dynamics, .transcription = "hermite-simpson"}, 20, fine.result.cost);
  }
  expect_agreement({.transcription = "hermite-simpson-separated"}, 20, fine.result.cost);
  expect_agreement({.dynamics = "forward", .transcription = "rk4"}, 40, fine.result.cost);
}

/// What prowl plan solves, and the same choices as a collocation in coordinates: two programs by two codes.
TEST(FormulationsAgree, ByBothCodesOfTheDefault) {
  const std::string file = std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/crouch.toml";
  const Task task = read_task_file(file, test::test_search(), {.intervals = 20});
  const DiscreteProblem discrete(task.problem, task.mesh);
  const Trajectory guess = initial_guess(discrete);
  const auto solved = [&](MotionNlp& nlp) {
    const SolveResult result = IpoptSolver().solve(nlp, nlp.pack(guess), task.solver);
    EXPECT_EQ(result.status, SolveStatus::converged) << result.message;
    return std::pair(result.cost, nlp.unpack(result.z));
  };
  const auto [cost, motion] = solved(*make_formulation({}, discrete, guess));
  const auto [cost_again, motion_again] = solved(*make_collocation({}, discrete, guess));
  EXPECT_NEAR(cost_again, cost, 1e-5 * cost);
  for (std::size_t k = 0; k < motion.nodes.size(); ++k) {
    EXPECT_LT((motion.nodes[k].q - motion_again.nodes[k].q).cwiseAbs().maxCoeff(), 1e-4);
    EXPECT_LT((motion.nodes[k].tau - motion_again.nodes[k].tau).cwiseAbs().maxCoeff(), 0.05);  // [N m]
  }
}

/// Away from the singularity the coordinates of the base's rotation make no difference.
TEST(FormulationsAgree, WithEulerAngles) {
  for (const std::string dynamics : {"inverse", "forward"}) {
    const Formulation se3{.dynamics = dynamics, .transcription = "hermite-simpson"};
    Formulation euler = se3;
    euler.orientation = "euler";
    const FormulationRun a = crouch(se3, 20), b = crouch(euler, 20);
    ASSERT_EQ(b.result.status, SolveStatus::converged) << b.result.message;
    EXPECT_NEAR(b.result.cost, a.result.cost, 1e-5 * a.result.cost);
    for (std::size_t k = 0; k < a.motion.nodes.size(); ++k) {
      EXPECT_LT((a.motion.nodes[k].q - b.motion.nodes[k].q).cwiseAbs().maxCoeff(), 1e-4);
    }
  }
}

}  // namespace
}  // namespace prowl
