// Plans the task argv[1] and prints what the backward pass of the feedback design sees, for riccati_scipy_test.py: one
// line a sample, last first: phase, sample, step [s], n, nu, then R⁻¹ (nu), A (n x n), B (n x nu), Q and S (n x n), row
// by row, with all digits. At most argv[2] samples of each phase, counted from its end.
#include <fmt/format.h>

#include <cstdlib>

#include "prowl/tracking/feedback_design.hpp"
#include "tests/support/solved_task.hpp"

namespace {

void print_numbers(const Eigen::MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) fmt::print(" {}", matrix(i, j));
  }
}

}  // namespace

int main(int, char** argv) {
  const prowl::test::SolvedTask solved = prowl::test::solve_task(argv[1]);
  const int most = std::atoi(argv[2]);
  const prowl::TrackingOptions& options = solved.task.tracking;
  const auto grid = prowl::reference_grid(solved.task.problem, solved.trajectory, options.step);
  const auto print_sample = [&](const prowl::ReducedSample& at) {
    const auto phase = static_cast<std::size_t>(at.phase);
    const double step = phase < grid.size() ? grid[phase].step() : options.step;
    const int samples = phase < grid.size() ? static_cast<int>(grid[phase].samples.size()) : 2;
    if (at.sample + most < samples) return;
    fmt::print("{} {} {} {} {}", at.phase, at.sample, step, at.A.rows(), at.B.cols());
    print_numbers(options.torque_weight().cwiseInverse());
    print_numbers(at.A);
    print_numbers(at.B);
    print_numbers(at.Q);
    print_numbers(at.S);
    fmt::print("\n");
  };
  prowl::design_feedback(solved.task.problem, solved.trajectory, options, print_sample);
}
