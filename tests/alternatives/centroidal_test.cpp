#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <set>

#include "alternatives/centroidal/centroidal_nlp.hpp"
#include "alternatives/inverse_dynamics_check.hpp"
#include "alternatives/run_formulation.hpp"
#include "prowl/error.hpp"
#include "prowl/guess/initial_guess.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/everything_problem.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/standing_problem.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::everything;
using test::free_phase;
using test::MeshedProblem;
using test::phase_on;

constexpr std::size_t kContacts = 4;

CentroidalNlp make_nlp(const DiscreteProblem& discrete) { return {discrete, initial_guess(discrete)}; }

MeshedProblem task_problem(const std::string& name, int intervals) {
  const Task task = read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/" + name + ".toml", test::test_search(),
                                   {.intervals = intervals});
  return {task.problem, task.mesh};
}

FormulationRun solve(const DiscreteProblem& discrete, const std::string& dynamics) {
  return run_formulation(discrete, {.dynamics = dynamics}, IpoptSolver(), {});
}

void expect_derivatives(const MeshedProblem& of, double size_of_multipliers = 2.0) {
  const DiscreteProblem discrete = of.discrete();
  const Trajectory guess = initial_guess(discrete);
  CentroidalNlp nlp(discrete, guess);
  std::mt19937 rng(5);
  const VectorXd z = nlp.pack(guess) + test::random_vector(rng, nlp.num_variables(), 0.1);
  const VectorXd multipliers = test::random_vector(rng, nlp.num_constraints(), size_of_multipliers);
  const test::DerivativeReport report = test::check_derivatives(nlp, z, 1.7, multipliers);
  EXPECT_LT(report.worst(), 1e-6) << report.summary();
  EXPECT_TRUE(report.pattern_faults.empty()) << report.pattern_faults.front();
}

TEST(CentroidalNlp, DerivativesAndPatternsAreThoseOfDifferences) {
  const RobotModel hyq = test::hyq();
  expect_derivatives(everything(hyq, {phase_on("four", {0, 1, 2, 3}, 0.3, 2)}));
  expect_derivatives(everything(hyq, {phase_on("four", {0, 1, 2, 3}, 0.3, 2), phase_on("three", {0, 1, 3}, 0.2, 1)}));
  expect_derivatives(everything(hyq, {phase_on("hind", {1, 3}, 0.3, 1), phase_on("flight", {}, 0.2, 1)}));
}

TEST(CentroidalNlp, DerivativesHoldForVelocitiesThatTheTaskBinds) {
  MeshedProblem of = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 2)});
  const DiscreteProblem without = of.discrete();
  of.problem.boundary_constraints[1].velocity_lower.head<6>().setZero();
  of.problem.boundary_constraints[1].velocity_upper.head<6>().setZero();
  const DiscreteProblem with = of.discrete();
  EXPECT_EQ(make_nlp(with).num_constraints(), make_nlp(without).num_constraints() + 3);
  expect_derivatives(of);
}

TEST(CentroidalNlp, DerivativesHoldForFreeDurationsAndContactsThatOpenAndLand) {
  auto [problem, mesh] =
      everything(test::hyq(), {free_phase("four", {0, 1, 2, 3}, 2), phase_on("lifted", {1, 2, 3}, 0.2, 2),
                               free_phase("landed", {0, 1, 2, 3}, 2), free_phase("on it", {0, 3}, 1)});
  problem.running_cost.time_weight = 2.3;
  problem.swing_clearance = 0.05;
  problem.surfaces.push_back({.name = "step",
                              .point = {0.4, 0.3, 0.1},
                              .normal = {0.1, 0.0, 1.0},
                              .patch = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}}});
  problem.surfaces[1].normal.normalize();
  problem.phases[2].contacts[0].surface = problem.phases[3].contacts[0].surface = 1;
  expect_derivatives({problem, mesh});
  problem.friction_model = FrictionModel::pyramid;
  problem.phases[2].contacts[0].foothold = problem.surfaces[1].point;
  expect_derivatives({problem, mesh});
}

TEST(CentroidalNlp, DerivativesHoldForFlatFeet) {
  auto [problem, mesh] = everything(
      test::talos(), {phase_on("left", {0, 1, 2, 3}, 0.3, 1), free_phase("both", {0, 1, 2, 3, 4, 5, 6, 7}, 1)});
  problem.running_cost.force_weight *= 0.1;  // heavier than HyQ: a cost of the same size, against rounding
  expect_derivatives({problem, mesh}, 0.5);
}

TEST(CentroidalNlp, WithoutItsRowsTheHessianIsThatOfTheCost) {
  const auto [problem, mesh] = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 2)});
  const DiscreteProblem discrete(problem, mesh);
  const Trajectory guess = initial_guess(discrete);
  CentroidalNlp nlp(discrete, guess);
  const VectorXd z = nlp.pack(guess);
  VectorXd exact(nlp.hessian_pattern().size()), gauss_newton = exact, of_cost = exact;
  std::mt19937 rng(5);
  const VectorXd multipliers = test::random_vector(rng, nlp.num_constraints(), 2.0);
  nlp.hessian(z, 1.3, VectorXd::Zero(nlp.num_constraints()), of_cost);
  nlp.hessian(z, 1.3, multipliers, exact);
  nlp.use_hessian(HessianKind::gauss_newton);
  nlp.hessian(z, 1.3, multipliers, gauss_newton);
  EXPECT_EQ(gauss_newton, of_cost);
  EXPECT_GT((exact - of_cost).norm(), 1.0);
}

int sum(const std::vector<RowGroup>& groups) {
  return std::accumulate(groups.begin(), groups.end(), 0,
                         [](int total, const RowGroup& of) { return total + of.count; });
}

testing::Matcher<RowGroup> group(const std::string& name, int count) {
  return testing::AllOf(testing::Field(&RowGroup::name, name), testing::Field(&RowGroup::count, count));
}

struct Counts {
  int variables, constraints;
  bool operator==(const Counts&) const = default;
};
void PrintTo(const Counts& counts, std::ostream* out) { *out << counts.variables << ", " << counts.constraints; }

/// What a node in the course of a phase adds to the program of HyQ's crouch: the difference of two meshes.
Counts counts_of_a_node(const Formulation& formulation, bool with_knee_curves = true) {
  const auto counts = [&](int intervals) {
    const std::string file = std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/crouch.toml";
    Task task = read_task_file(file, test::test_search(), {.intervals = intervals});
    if (!with_knee_curves) task.problem.robot = test::hyq();
    const DiscreteProblem discrete(task.problem, task.mesh);
    const auto nlp = make_formulation(formulation, discrete, initial_guess(discrete));
    return Counts{nlp->num_variables(), nlp->num_constraints()};
  };
  const Counts few = counts(40), many = counts(80);
  EXPECT_EQ((many.variables - few.variables) % 40, 0);
  EXPECT_EQ((many.constraints - few.constraints) % 40, 0);
  return {(many.variables - few.variables) / 40, (many.constraints - few.constraints) / 40};
}

TEST(Formulations, CountsOfANodeBesideThoseOfThePaper) {
  const Formulation of_the_paper{.dynamics = "forward", .contact = "distance"};
  const Counts projection = counts_of_a_node(of_the_paper), centroidal = counts_of_a_node({.dynamics = "centroidal"});
  fmt::print(
      "variables, constraints of a node, HyQ on four feet (Pardo et al. 2016, table I)\n"
      "projection: {}, {} (49, 48): the paper has the step as a variable; Prowl has two rows a knee, not one\n"
      "centroidal: {}, {} (76, 63): the paper has the step as a variable; Prowl has a row of friction a foot\n",
      projection.variables, projection.constraints, centroidal.variables, centroidal.constraints);
  EXPECT_EQ(projection, (Counts{48, 52}));
  EXPECT_EQ(centroidal, (Counts{75, 67}));
  EXPECT_EQ(counts_of_a_node(of_the_paper, false), (Counts{48, 52 - 8})) << "8 rows are those of the knees";
}

/// The sums of both lists are Prowl's counts above.
TEST(CentroidalNlp, GroupsOfANodeSayWhatItsCountsAre) {
  const DiscreteProblem discrete = task_problem("hyq/crouch", 80).discrete();
  CentroidalNlp nlp = make_nlp(discrete);
  const std::vector<RowGroup> variables = nlp.variable_groups(7), constraints = nlp.constraint_groups(7);
  EXPECT_THAT(variables,
              testing::ElementsAre(group("q", 18), group("v", 18), group("r", 3), group("r'", 3), group("h", 3),
                                   group("c", 12), group("r''", 3), group("h'", 3), group("f", 12)));
  EXPECT_EQ(sum(variables), 75);
  EXPECT_THAT(constraints, testing::ElementsAre(group("m r'' = sum f + m g", 3), group("h' = sum (c - r) x f", 3),
                                                group("h = A_G(q) v", 3), group("r = com(q)", 3), group("c = p(q)", 12),
                                                group("distance of contacts to their surfaces", 4),
                                                group("friction", 4), group("q by backward Euler", 18),
                                                group("h by backward Euler", 3), group("r by the trapezoid", 3),
                                                group("r' by backward Euler", 3), group("contacts do not slide", 8)));
  EXPECT_EQ(sum(constraints), 67);
}

TEST(CentroidalNlp, GroupsAreAllThatThereIs) {
  const auto [problem, mesh] =
      everything(test::hyq(), {free_phase("four", {0, 1, 2, 3}, 2), phase_on("lifted", {1, 2, 3}, 0.2, 2),
                               phase_on("landed", {0, 1, 2, 3}, 0.2, 2)});
  const DiscreteProblem discrete(problem, mesh);
  CentroidalNlp nlp = make_nlp(discrete);
  int variables = 1, constraints = 0;  // the free duration
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    variables += sum(nlp.variable_groups(k));
    constraints += sum(nlp.constraint_groups(k));
  }
  EXPECT_EQ(variables, nlp.num_variables());
  EXPECT_EQ(constraints, nlp.num_constraints());
}

TEST(CentroidalNlp, SaysInWordsWhatRowsAndVariablesAre) {
  const auto [problem, mesh] =
      everything(test::hyq(), {free_phase("four", {0, 1, 2, 3}, 2), phase_on("lifted", {1, 2, 3}, 0.2, 2)});
  const DiscreteProblem discrete(problem, mesh);
  CentroidalNlp nlp = make_nlp(discrete);
  std::vector<std::string> rows, variables;
  for (int i = 0; i < nlp.num_constraints(); ++i) rows.push_back(nlp.describe_constraint(i));
  for (int i = 0; i < nlp.num_variables(); ++i) variables.push_back(nlp.describe_variable(i));
  EXPECT_EQ(std::set(rows.begin(), rows.end()).size(), rows.size());
  EXPECT_EQ(std::set(variables.begin(), variables.end()).size(), variables.size());
  EXPECT_THAT(rows,
              testing::IsSupersetOf({"phase 1 'four', node 1, forces, z, t = 0.175 s",
                                     "phase 1 'four', node 2, lf_foot, force before it opens, x, t = 0.350 s",
                                     "phase 1 'four', node 1, lh_foot, sliding along axis 2 of floor, t = 0.175 s",
                                     "phase 2 'lifted', node 0, q across the phase transition, base x, t = 0.350 s"}));
  EXPECT_THAT(variables, testing::IsSupersetOf({"phase 1 'four', node 1, f z of rf_foot, t = 0.175 s",
                                                "phase 1 'four', node 0, v lf_kfe_joint, t = 0.000 s",
                                                "phase 1 'four', duration"}));
}

TEST(CentroidalNlp, UnpackUndoesPack) {
  const auto [problem, mesh] =
      everything(test::hyq(), {free_phase("four", {0, 1, 2, 3}, 3), phase_on("two", {0, 3}, 0.2, 2)});
  const DiscreteProblem discrete(problem, mesh);
  const Trajectory guess = initial_guess(discrete);
  CentroidalNlp nlp(discrete, guess);
  const Trajectory motion = nlp.unpack(nlp.pack(guess));
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    const TrajectoryPoint &was = guess.nodes[k], &is = motion.nodes[k];
    EXPECT_NEAR(is.time, was.time, 1e-12);
    EXPECT_LT((is.q - was.q).norm(), 1e-12);
    EXPECT_LT((is.v - was.v).norm(), 1e-12);
    if (discrete.nodes[k].node > 0) EXPECT_LT((is.force - was.force).norm(), 1e-9);
  }
  VectorXd z = nlp.pack(guess);
  z(3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(nlp.unpack(z), NumericalError);
}

TEST(CentroidalNlp, RefusesWhatItCannotSay) {
  MotionProblem problem = test::with_base_goal(test::standing_problem(), {0.0, 0.0, -0.05});
  const DiscreteProblem discrete = test::on_even_mesh(problem, 8);
  EXPECT_NO_THROW(make_nlp(discrete));
  const Trajectory guess = initial_guess(discrete);
  EXPECT_THROW(make_centroidal({.dynamics = "centroidal", .transcription = "rk4"}, discrete, guess), InputError);
  problem.boundary_constraints[1].torque_upper.setConstant(10.0);
  const DiscreteProblem with_torques = test::on_even_mesh(problem, 8);
  EXPECT_THROW(make_nlp(with_torques), InputError);
}

/// Forces, moments and momenta of a motion by its q, v and forces alone.
struct Balance {
  Vector3d com, momentum, force, moment;
};
std::vector<Balance> balance(const MotionProblem& problem, const Trajectory& motion) {
  CentroidalKinematics kinematics(problem.robot);
  RigidBodyTerms terms(problem.robot);
  std::vector<Balance> balances;
  for (const TrajectoryPoint& point : motion.nodes) {
    kinematics.update(point.q, point.v);
    terms.update_kinematics(point.q);
    Balance& now = balances.emplace_back(Balance{kinematics.com(), kinematics.momentum().tail<3>(),
                                                 -problem.robot.weight() * Vector3d::UnitZ(), Vector3d::Zero()});
    for (std::size_t c = 0; c < kContacts; ++c) {
      const Vector3d f = point.force.segment<3>(static_cast<Eigen::Index>(3 * c));
      now.force += f;
      now.moment += (terms.contact_position(static_cast<int>(c)) - now.com).cross(f);
    }
  }
  return balances;
}

/// Over two steps of the trapezoid for r and of backward Euler for r', second differences of r are the mean of two
/// forces.
void expect_balance(const MotionProblem& problem, const Trajectory& motion) {
  const std::vector<Balance> at = balance(problem, motion);
  const double dt = motion.nodes[1].time, weight = problem.robot.weight();
  for (std::size_t k = 2; k < at.size(); ++k) {
    const Vector3d acceleration = (at[k].com - 2.0 * at[k - 1].com + at[k - 2].com) / (dt * dt);
    if (k > 2) {
      EXPECT_LT((problem.robot.mass() * acceleration - 0.5 * (at[k].force + at[k - 1].force)).norm(), 1e-3 * weight)
          << k;
    }
    EXPECT_LT(((at[k].momentum - at[k - 1].momentum) / dt - at[k].moment).norm(), 1e-4 * weight) << k;
  }
}

double drift(const MotionProblem& problem, const Trajectory& motion) {
  RigidBodyTerms terms(problem.robot);
  std::vector<Vector3d> positions;
  double worst = 0.0;
  for (const TrajectoryPoint& point : motion.nodes) {
    terms.update_kinematics(point.q);
    for (int c = 0; c < static_cast<int>(kContacts); ++c) {
      if (positions.size() < kContacts) positions.push_back(terms.contact_position(c));
      worst = std::max(worst, (terms.contact_position(c) - positions[c]).norm());
    }
  }
  return worst;
}

TEST(CentroidalNlp, StandsAndCrouchesWithTheForcesThatItsMomentumNeeds) {
  for (const char* name : {"hyq/stand", "hyq/crouch"}) {
    const auto [problem, mesh] = task_problem(name, 60);
    const FormulationRun run = solve({problem, mesh}, "centroidal");
    ASSERT_EQ(run.result.status, SolveStatus::converged) << name;
    expect_balance(problem, run.motion);
    EXPECT_LT(drift(problem, run.motion), 1e-5) << name;
    // Start, goals and joint limits are the certificate's to judge; the motion between its nodes is first order.
    for (const char* check : {"start", "goal", "joint position beyond limit", "joint velocity", "friction cone"}) {
      int found = 0;
      for (const CertificateCheck& done : run.certificate.checks) {
        if (!done.name.starts_with(check)) continue;
        ++found;
        EXPECT_TRUE(done.passed) << name << ", " << done.name << " " << done.worst;
      }
      EXPECT_GT(found, 0) << check;
    }
  }
}

/// Its motion costs a whole robot hardly more than the best that a whole-body program finds, and what it leaves on the
/// base goes down with the step.
TEST(CentroidalNlp, InverseDynamicsAgreeWithItBetterOnAFinerMesh) {
  auto [problem, mesh] = task_problem("hyq/stand", 40);
  const FormulationRun whole_body = solve({problem, mesh}, "inverse");
  const InverseDynamicsCheck itself = check_by_inverse_dynamics(problem, whole_body.motion);
  EXPECT_NEAR(itself.cost, whole_body.result.cost, 1e-5 * whole_body.result.cost);
  EXPECT_LT(itself.worst_base_force, 1e-5);
  EXPECT_LT(itself.worst_base_moment, 1e-5);

  const InverseDynamicsCheck coarse = check_by_inverse_dynamics(problem, solve({problem, mesh}, "centroidal").motion);
  EXPECT_GT(coarse.cost, whole_body.result.cost);
  EXPECT_LT(coarse.cost, 1.03 * whole_body.result.cost);
  EXPECT_GT(coarse.mean_base_force, 0.0);
  mesh.phases[0] = PhaseMesh(2 * mesh.phases[0].intervals());
  const InverseDynamicsCheck fine = check_by_inverse_dynamics(problem, solve({problem, mesh}, "centroidal").motion);
  EXPECT_LT(fine.mean_base_force, 0.6 * coarse.mean_base_force);
  EXPECT_LT(fine.cost, coarse.cost);
}

/// Its contact opens, swings over its clearance, and lands at rest where the task has it.
TEST(CentroidalNlp, Steps) {
  const auto [problem, mesh] = task_problem("hyq/step", 50);
  const DiscreteProblem discrete(problem, mesh);
  const FormulationRun run = solve(discrete, "centroidal");
  ASSERT_EQ(run.result.status, SolveStatus::converged);
  const int lf = problem.robot.contact_index("lf_foot");
  const std::vector<TrajectoryPoint>& nodes = run.motion.nodes;
  const TrajectoryPoint &landing = nodes[discrete.mesh.first_node(2)], &before = nodes[discrete.mesh.last_node(0)];
  const TrajectoryPoint& middle = nodes[discrete.mesh.node(1, discrete.mesh.phases[1].intervals() / 2)];
  RigidBodyTerms terms(problem.robot);
  ContactKinematics foot({lf});
  terms.update_kinematics(landing.q);
  foot.set_configuration(terms);
  const double radius = problem.robot.contacts()[lf].radius;
  EXPECT_LT((foot.positions() - *problem.phases[2].contacts[0].foothold - radius * Vector3d::UnitZ()).norm(), 1e-5);
  EXPECT_LT((foot.jacobian() * landing.v).norm(), 1e-5);
  EXPECT_LT(before.force.segment<3>(3 * lf).norm(), 1e-3);
  terms.update_kinematics(middle.q);
  EXPECT_GT(terms.contact_position(lf).z() - radius, 0.95 * problem.swing_clearance);
  const double best = solve(discrete, "inverse").result.cost;
  EXPECT_NEAR(check_by_inverse_dynamics(problem, run.motion).cost, best, 0.02 * best);
}

}  // namespace
}  // namespace prowl
