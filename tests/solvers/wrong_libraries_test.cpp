// Solvers where other libraries are loaded than Prowl was built with: this program's own functions are found before
// theirs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "prowl/solvers/foreign/fatrop_solver.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/solvers/foreign/uno_solver.hpp"
#include "tests/solvers/cart.hpp"

extern "C" {
void GetIpoptVersion(int* major, int* minor, int* release) {
  *major = 3;
  *minor = 13;
  *release = 4;
}
void uno_get_version(int* major, int* minor, int* patch) {
  *major = 3;
  *minor = *patch = 0;
}
/// As one that was built for AVX2, on a processor that has no more than SSE3.
void blasfeo_processor_library_string(char* text) { std::strcpy(text, "AVX2 FMA "); }
int blasfeo_processor_cpu_features(int* features) {
  *features = 0x8;
  return 0;
}
}

namespace prowl {
namespace {

using ::testing::HasSubstr;

void expect_refused(const NlpSolver& solver, const std::string& reason) {
  test::Cart cart;
  EXPECT_THAT(solver.why_unsupported(cart).value_or(""), HasSubstr(reason)) << solver.name();
  const SolveResult result = solver.solve(cart, test::Cart::zeros(), {});
  EXPECT_EQ(result.status, SolveStatus::solver_failed) << solver.name();
  EXPECT_THAT(result.message, HasSubstr(reason)) << solver.name();
  EXPECT_EQ(result.z, test::Cart::zeros());
}

TEST(WrongLibraries, AreNotUsed) {
  expect_refused(IpoptSolver(), "is Ipopt 3.13.4, and this Prowl was built with Ipopt 3.14");
  expect_refused(IpoptSolver(IpoptLinearSolver::spral), "is Ipopt 3.13.4");
  expect_refused(UnoSolver(), "libuno.so is Uno 3.0.0, and this Prowl was built with Uno 2.7");
  expect_refused(FatropSolver(), "libblasfeo.so needs a processor with AVX2, FMA, which this one lacks: install");
  EXPECT_EQ(IpoptSolver().version(), "3.13.4");
  EXPECT_TRUE(IpoptSolver::why_wrong_library().has_value());
}

}  // namespace
}  // namespace prowl
