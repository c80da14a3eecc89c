// Microseconds of the projected residual and of its derivatives on one core: HyQ on four feet, and what Prowl builds on.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <random>

#include "prowl/dynamics/projected_residual.hpp"
#include "prowl/model/configuration.hpp"
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

BENCHMARK(residual)->Unit(benchmark::kMicrosecond);
BENCHMARK(residual_and_first_derivatives)->Unit(benchmark::kMicrosecond);
BENCHMARK(second_derivatives_besides)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
