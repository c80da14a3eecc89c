// IpoptSolver where libipopt.so was built without SPRAL: this program's own function is found before the library's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "tests/nlp/test_problems.hpp"

extern "C" unsigned IpoptGetAvailableLinearSolvers(int) { return 0x400; }  // IPOPTLINEARSOLVER_MUMPS

namespace prowl {
namespace {

using test::Hs071;
using ::testing::HasSubstr;

TEST(IpoptWithoutSpral, SaysWhatIsMissing) {
  Hs071 nlp;
  const IpoptSolver spral(IpoptLinearSolver::spral);
  EXPECT_THAT(spral.why_unsupported(nlp).value_or(""), HasSubstr("built without SPRAL"));
  const SolveResult result = spral.solve(nlp, Hs071::guess(), {});
  EXPECT_EQ(result.status, SolveStatus::solver_failed);
  EXPECT_THAT(result.message, HasSubstr("built without SPRAL"));
  EXPECT_EQ(result.z, Hs071::guess());
}

TEST(IpoptWithoutSpral, SolvesWithMumps) {
  Hs071 nlp;
  EXPECT_EQ(IpoptSolver().why_unsupported(nlp), std::nullopt);
  EXPECT_EQ(IpoptSolver().solve(nlp, Hs071::guess(), {}).status, SolveStatus::converged);
}

}  // namespace
}  // namespace prowl
