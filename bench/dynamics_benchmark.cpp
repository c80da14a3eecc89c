// Microseconds of the projected residual, of all functions of a node and of their derivatives on one core: HyQ on four
// feet.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <random>

#include "prowl/dynamics/projected_residual.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/transcription/node/node_functions.hpp"
#include "tests/support/everything_problem.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"

namespace {

struct Setup {
  prowl::RobotModel robot = prowl::test::hyq();
  std::vector<int> contacts{0, 1, 2, 3};
  std::vector<prowl::DynamicsPoint> points;
  Setup() {
    std::mt19937 rng(1);
    for (int i = 0; i < 64; ++i) points.push_back(prowl::test::random_point(robot, contacts, rng));
  }
};

const Setup& setup() {
  static const Setup instance;
  return instance;
}

template <class Evaluate>
void run(benchmark::State& state, Evaluate evaluate) {
  prowl::ProjectedResidual dynamics(setup().robot, setup().contacts);
  std::size_t i = 0;
  for (auto _ : state) {
    evaluate(dynamics, setup().points[i++ % setup().points.size()]);
    benchmark::DoNotOptimize(dynamics.residual().data());
  }
}

void residual(benchmark::State& state) {
  run(state, [](auto& dynamics, const auto& point) { dynamics.evaluate(point); });
}

void residual_and_first_derivatives(benchmark::State& state) {
  run(state, [](auto& dynamics, const auto& point) { dynamics.evaluate_with_derivatives(point); });
}

void second_derivatives_besides(benchmark::State& state) {
  prowl::ProjectedResidual dynamics(setup().robot, setup().contacts);
  const prowl::DynamicsPoint& point = setup().points.front();
  dynamics.evaluate_with_derivatives(point);
  const Eigen::VectorXd mu = Eigen::VectorXd::Ones(point.v.size()), nu = Eigen::VectorXd::Ones(point.anchors.size());
  for (auto _ : state) benchmark::DoNotOptimize(dynamics.hessian(point, mu, nu).qq.data());
}

/// A node of a phase with every kind of cost, on four feet with friction cones, of fixed duration.
template <class Evaluate>
void run_node(benchmark::State& state, Evaluate evaluate) {
  const prowl::DiscreteProblem discrete =
      prowl::test::everything(setup().robot, {prowl::test::phase_on("four", setup().contacts, 0.3, 2)}).discrete();
  prowl::NodeFunctions functions(discrete, 0, {{}, std::vector<prowl::LandingAxes>(4)});
  std::vector<prowl::NodePoint> points;
  for (const prowl::DynamicsPoint& at : setup().points) {
    points.push_back({.node = 1,
                      .q = at.q,
                      .v = at.v,
                      .a = at.a,
                      .tau = at.tau,
                      .w = {},
                      .theta = {0.3, -0.2, 0.5},
                      .duration = 0.3,
                      .anchors = at.anchors,
                      .cost_weight = 0.1});
  }
  prowl::NodeValues values;
  const Eigen::VectorXd multipliers = Eigen::VectorXd::Ones(functions.num_rows(1));
  Eigen::MatrixXd hessian;
  std::size_t i = 0;
  for (auto _ : state) {
    evaluate(functions, points[i++ % points.size()], multipliers, values, hessian);
    benchmark::DoNotOptimize(values.rows.data());
  }
}

void node_functions(benchmark::State& state) {
  run_node(state,
           [](auto& functions, const auto& point, auto&, auto& values, auto&) { functions.evaluate(point, values); });
}

void node_functions_with_derivatives(benchmark::State& state) {
  run_node(state, [](auto& functions, const auto& point, auto&, auto& values, auto&) {
    functions.evaluate_with_derivatives(point, values);
  });
}

void node_functions_linearised(benchmark::State& state) {
  run_node(state, [](auto& functions, const auto& point, const auto& multipliers, auto& values, auto& hessian) {
    functions.linearise(point, 1.0, multipliers, values, hessian);
  });
}

BENCHMARK(residual)->Unit(benchmark::kMicrosecond);
BENCHMARK(residual_and_first_derivatives)->Unit(benchmark::kMicrosecond);
BENCHMARK(second_derivatives_besides)->Unit(benchmark::kMicrosecond);
BENCHMARK(node_functions)->Unit(benchmark::kMicrosecond);
BENCHMARK(node_functions_with_derivatives)->Unit(benchmark::kMicrosecond);
BENCHMARK(node_functions_linearised)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
