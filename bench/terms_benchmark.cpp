// Microseconds that each kind of term adds to a node on one core: value, first and second derivatives; HyQ.
#include <benchmark/benchmark.h>

#include <random>

#include "prowl/motion/term_evaluation.hpp"
#include "prowl/terms/own_term.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/terms_problem.hpp"

namespace {

using prowl::TermUse;

void linearise(benchmark::State& state, const TermUse& use) {
  const prowl::RobotModel robot = prowl::test::hyq();
  const std::vector<int> contacts{0, 1, 2, 3};
  std::mt19937 rng(1);
  const prowl::DynamicsPoint point = prowl::test::random_point(robot, contacts, rng);
  const Eigen::Index columns = 3 * robot.nv() + robot.nu();
  const Eigen::VectorXd forces = prowl::test::random_vector(rng, 12, 100.0);
  const Eigen::MatrixXd forces_dx = prowl::test::random_matrix(rng, 12, columns, 1.0);
  const Eigen::VectorXd multipliers = Eigen::VectorXd::Ones(use.term->num_rows());
  prowl::RigidBodyTerms kinematics(robot);
  kinematics.update_kinematics(point.q);
  prowl::TermEvaluation term(robot, use, contacts);
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(columns, columns);
  for (auto _ : state) {
    term.evaluate({kinematics, point.q, point.v, point.tau, forces, 0.0});
    term.differentiate(forces_dx);
    term.add_hessian(multipliers, hessian);
    benchmark::DoNotOptimize(hessian.data());
  }
}

std::vector<TermUse> all_terms() {
  std::vector<TermUse> terms = prowl::test::every_term(prowl::test::hyq(), "lf_foot", "rh_upperleg", 1);
  const auto clear_of_ball = prowl::own_term<3, 1>({{.name = "lf_foot"}}, {"distance"}, "m",
                                                   [](const auto& y, auto& f) { f(0) = y.norm() - 0.1; });
  terms.push_back(prowl::test::limit_on("own term, distance of a point", clear_of_ball, 0.0, 9.0));
  return terms;
}

}  // namespace

int main(int argc, char** argv) {
  for (const TermUse& use : all_terms()) {
    benchmark::RegisterBenchmark(use.name.c_str(), linearise, use)->Unit(benchmark::kMicrosecond);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
