#pragma once

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "alternatives/formulation.hpp"
#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/guess/initial_guess.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/standing_problem.hpp"

/// What a rule of integration makes of given torques: they are linear in time over all of the motion, so that every
/// rule has them exactly, and there is no goal and no cost. A square system of equations; no limit is active.
namespace prowl::test {

constexpr double kGivenDuration = 0.4;  // [s]

/// HyQ sinks, leans and turns; without contacts it only moves its legs.
inline Eigen::VectorXd given_torques(const MotionProblem& problem, double t) {
  const std::vector<int> contacts = contact_indices(problem.phases[0].contacts);
  if (contacts.empty()) return t / kGivenDuration * Eigen::VectorXd::LinSpaced(problem.robot.nu(), -0.4, 0.6);
  Eigen::VectorXd tau = static_equilibrium(problem.robot, problem.start_configuration(), contacts).tau;
  const Eigen::VectorXd change = Eigen::VectorXd::LinSpaced(tau.size(), -4.0, 6.0);
  return 0.95 * tau + t / kGivenDuration * change;
}

enum class Given { standing, tumbling };

inline DiscreteProblem given_motion(int intervals, Given given_start = Given::standing) {
  MotionProblem problem = standing_problem(hyq(), 0.0, 2.0);
  problem.phases[0].duration = {kGivenDuration, kGivenDuration};
  BoundaryConstraint& start = problem.boundary_constraints.front();
  if (given_start == Given::tumbling) {
    problem.phases[0].contacts.clear();
    start.q_ref(2) += 2.0;
    Eigen::VectorXd v = Eigen::VectorXd::Zero(problem.robot.nv());
    v.head<3>() << 0.5, -0.3, 1.0;
    v.segment<3>(3) << 1.2, -0.8, 1.6;
    start.velocity_lower = start.velocity_upper = v;
  }
  start.torque_lower = start.torque_upper = given_torques(problem, 0.0);
  for (int k = 1; k <= intervals; ++k) {
    auto given =
        BoundaryConstraint::unbounded(problem.robot, "torque", {0, 1.0 * k / intervals}, problem.start_configuration());
    given.torque_lower = given.torque_upper = given_torques(problem, kGivenDuration * k / intervals);
    problem.boundary_constraints.push_back(given);
  }
  return on_even_mesh(std::move(problem), intervals);
}

/// The program with the torques in the middle of intervals given, too.
struct GivenTorques : MotionNlp {
  GivenTorques(std::unique_ptr<MotionNlp> program, const DiscreteProblem& discrete)
      : MotionNlp(discrete), inner(std::move(program)) {
    variable_lower_ = inner->variable_lower();
    variable_upper_ = inner->variable_upper();
    constraint_lower_ = inner->constraint_lower();
    constraint_upper_ = inner->constraint_upper();
    jacobian_pattern_ = inner->jacobian_pattern();
    hessian_pattern_ = inner->hessian_pattern();
    const int intervals = discrete.mesh.num_intervals();
    for (int k = 0; k < intervals; ++k) {
      const Eigen::VectorXd tau = given_torques(problem(), kGivenDuration * (k + 0.5) / intervals);
      for (int j = 0; j < num_variables(); ++j) {
        const std::string name = describe_variable(j), at = "node " + std::to_string(k) + ",";
        if (name.find(at) == std::string::npos || name.find("in the interval after it, torque") == std::string::npos) {
          continue;
        }
        for (int i = 0; i < tau.size(); ++i) {
          if (!name.ends_with(problem().robot.joint_names()[i])) continue;
          variable_lower_(j) = variable_upper_(j) = tau(i);
        }
      }
    }
  }
  Eigen::VectorXd pack(const Trajectory& t) const override { return inner->pack(t); }
  Trajectory unpack(const Eigen::VectorXd& z) override { return inner->unpack(z); }
  void use_hessian(HessianKind kind) override { inner->use_hessian(kind); }
  double cost(const Eigen::VectorXd& z) override { return inner->cost(z); }
  void cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) override { inner->cost_gradient(z, g); }
  void constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) override { inner->constraints(z, g); }
  void jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> v) override { inner->jacobian(z, v); }
  void hessian(const Eigen::VectorXd& z, double f, const Eigen::VectorXd& m, Eigen::Ref<Eigen::VectorXd> v) override {
    inner->hessian(z, f, m, v);
  }
  std::string describe_constraint(int row) const override { return inner->describe_constraint(row); }
  std::string describe_variable(int index) const override { return inner->describe_variable(index); }

  std::unique_ptr<MotionNlp> inner;

 private:
  void evaluate_all(const Eigen::VectorXd&, bool) override {}  // the program does
};

/// Where the motion is at its end. Throws std::runtime_error if the equations are not solved.
inline TrajectoryPoint end_of_given_motion(const Formulation& formulation, int intervals,
                                           Given start = Given::standing) {
  const DiscreteProblem discrete = given_motion(intervals, start);
  const Trajectory guess = initial_guess(discrete);
  GivenTorques nlp(make_collocation(formulation, discrete, guess), discrete);
  const SolveResult result = IpoptSolver().solve(nlp, nlp.pack(guess), {.tolerance = 1e-11, .max_iterations = 60});
  if (result.status != SolveStatus::converged)
    throw std::runtime_error(formulation.transcription + ": " + result.message);
  return nlp.unpack(result.z).nodes.back();
}

struct StateError {
  double q, v, force;
};

/// The largest differences.
inline StateError state_error(const TrajectoryPoint& a, const TrajectoryPoint& b) {
  return {difference(a.q, b.q).cwiseAbs().maxCoeff(), (a.v - b.v).cwiseAbs().maxCoeff(),
          (a.force - b.force).cwiseAbs().maxCoeff()};
}

}  // namespace prowl::test
