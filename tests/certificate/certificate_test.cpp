#include "prowl/certificate/certificate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/certificate/certificate_cases.hpp"
#include "tests/certificate/stance_motion.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using test::Case;
using test::crouching;
using test::failed_checks;
using test::find;
using test::Names;
using test::standing;

void set_robot(Case& c, const RobotDescription& description) { c.discrete.problem.robot = RobotModel(description); }

TEST(Certificate, StandingStillIsCertifiedForEveryRobot) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2(), test::talos()}) {
    const Case c = standing(robot);
    const Certificate certificate = certify(c.discrete, c.trajectory);
    EXPECT_EQ(failed_checks(certificate), Names{}) << robot.name();
    EXPECT_EQ(certificate.grade, CertificateGrade::certified) << robot.name();
    EXPECT_GE(certificate.checks.size(), 18u);
    EXPECT_EQ(certificate.interval_errors.size(), 10u);
  }
}

TEST(Certificate, AMotionOnAFineMeshPasses) {
  const Case c = crouching(test::hyq(), 400);
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_EQ(failed_checks(certificate), Names{});
  EXPECT_TRUE(certificate.passed);
  EXPECT_NE(certificate.grade, CertificateGrade::failed);
  EXPECT_GT(find(certificate, "joint velocity").worst, 0.01) << "it does not move, so the test checks nothing";
}

TEST(Certificate, AMotionOnACoarseMeshFailsByItsIntegration) {
  const Case c = crouching(test::hyq(), 4);
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_FALSE(certificate.passed);
  EXPECT_EQ(certificate.grade, CertificateGrade::failed);
  EXPECT_FALSE(find(certificate, "local integration error").passed);
  EXPECT_TRUE(find(certificate, "defect").passed) << "the trapezoid meets the nodes, which says nothing";
}

TEST(Certificate, ForcesDecideNotWhatThePlannerSaysOfThem) {
  Case c = standing(test::hyq());
  const double truth = find(certify(c.discrete, c.trajectory), "friction cone").worst;
  for (TrajectoryPoint& node : c.trajectory.nodes) node.force.array() += 3.0;
  EXPECT_EQ(find(certify(c.discrete, c.trajectory), "friction cone").worst, truth);
}

// --- Sabotage: each fault of a standing HyQ fails the check that is there for it, and no other ---

struct Sabotage {
  std::string name;
  std::function<void(Case&)> commit;
  Names fails;
};

/// Adds internal forces (they balance each other on the body) of world direction (x, y, z) with the sign pattern lf +,
/// lh s, rf t, rh u, and the torques that go with them.
void squeeze(Case& c, const Eigen::Vector3d& force, const Eigen::Vector4d& signs) {
  test::StanceMotion motion(c.discrete.problem.robot, 1.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  Eigen::VectorXd internal(12);
  for (int foot = 0; foot < 4; ++foot) internal.segment<3>(3 * foot) = signs(foot) * force;
  const Eigen::MatrixXd J = motion.jacobian(c.trajectory.nodes.front().q);
  ASSERT_LT((J.leftCols(6).transpose() * internal).norm(), 1e-6) << "the forces must balance";
  for (TrajectoryPoint& node : c.trajectory.nodes) {
    node.force += internal;
    node.tau -= J.rightCols(c.discrete.problem.robot.nu()).transpose() * internal;
  }
}

/// One leg swings outwards at its hip at a constant rate, while the torques go on carrying the robot.
void drift(Case& c, double duration, double rate) {
  test::StanceMotion motion(c.discrete.problem.robot, 1.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k < c.trajectory.nodes.size(); ++k) {
    TrajectoryPoint& node = c.trajectory.nodes[k];
    node.time *= duration;
    node.q(7) += rate * node.time;
    node.v(6) = rate;
    motion.add_forces(node);
  }
  MotionProblem& problem = c.discrete.problem;
  for (Phase& phase : problem.phases) phase.duration = {phase.duration.min * duration, phase.duration.max * duration};
  problem.boundary_constraints = {
      test::fixed_state(problem.robot, "start", PhaseFraction::start_of(0), c.trajectory.nodes[0].q,
                        c.trajectory.nodes[0].v),
      test::free_constraint(problem.robot, "goal", problem.boundary_constraints[1].at, c.trajectory.nodes[0].q)};
}

/// Cuts the only phase in two of the same contacts.
void split_phase(Case& c) {
  MotionProblem problem = c.discrete.problem;
  auto& phases = problem.phases;
  auto& nodes = c.trajectory.nodes;
  const int intervals = c.discrete.mesh.num_intervals(), half = intervals / 2;
  const double transition_time = nodes[half].time;
  const double end = nodes.back().time;
  nodes.insert(nodes.begin() + half, nodes[half]);
  for (std::size_t k = half + 1; k < nodes.size(); ++k) nodes[k].phase = 1;
  phases.push_back(phases[0]);
  phases[0].duration = {transition_time, transition_time};
  phases[1].duration = {end - transition_time, end - transition_time};
  problem.boundary_constraints[1].at = PhaseFraction::end_of(1);
  c.discrete = {std::move(problem), {{PhaseMesh(half), PhaseMesh(intervals - half)}}};
}

/// Unit of a check of HyQ standing, after a fault.
std::string unit_of(const char* check, const std::function<void(Case&)>& fault) {
  Case c = test::standing(test::hyq());
  fault(c);
  return test::find(certify(c.discrete, c.trajectory), check).unit;
}

constexpr const char* kFinite = "finite numbers, unit quaternions";
constexpr const char* kNodes = "nodes fit the problem";

BoundaryConstraint& goal(Case& c) { return c.discrete.problem.boundary_constraints[1]; }

std::vector<Sabotage> state_sabotage() {
  return {
      {"NaN in a torque", [](Case& c) { c.trajectory.nodes[3].tau(2) = std::nan(""); }, {kFinite}},
      {"infinite force", [](Case& c) { c.trajectory.nodes[3].force(2) = INFINITY; }, {kFinite}},
      {"quaternion not of unit norm", [](Case& c) { c.trajectory.nodes[3].q(6) *= 1.01; }, {kFinite}},
      {"node missing", [](Case& c) { c.trajectory.nodes.pop_back(); }, {kNodes}},
      {"node too many", [](Case& c) { c.trajectory.nodes.push_back(c.trajectory.nodes.back()); }, {kNodes}},
      {"no nodes", [](Case& c) { c.trajectory.nodes.clear(); }, {kNodes}},
      {"time goes back", [](Case& c) { c.trajectory.nodes[4].time = 0.0; }, {kNodes}},
      {"velocity of wrong size", [](Case& c) { c.trajectory.nodes[4].v.resize(3); }, {kNodes}},
      {"other start", [](Case& c) { c.discrete.problem.boundary_constraints[0].q_ref(9) += 1e-3; }, {"start state"}},
      {"goal 2 mm away", [](Case& c) { goal(c).q_ref(1) -= 2e-3; }, {"goal position"}},
      {"goal 2 mrad away", [](Case& c) { goal(c).q_ref(12) += 2e-3; }, {"goal angle"}},
      {"goal still turned",
       [](Case& c) { set_base_rotation(goal(c).q_ref, base_rotation(goal(c).q_ref) * so3::exp({0, 0, 2e-3})); },
       {"goal angle"}},
      {"goal moves", [](Case& c) { goal(c).velocity_lower.array() += 0.01; }, {"goal velocity"}},
      {"goal torque",
       [](Case& c) { goal(c).torque_upper(4) = c.trajectory.nodes.back().tau(4) - 1.0; },
       {"goal torque"}},
      {"phase too long", [](Case& c) { c.discrete.problem.phases[0].duration = {0.5, 0.99}; }, {"phase duration"}},
      {"node out of line", [](Case& c) { c.trajectory.nodes[5].q(0) += 1e-4; }, {"defect", "total defect"}},
      {"jump at a phase switch",
       [](Case& c) {
         split_phase(c);
         for (std::size_t k = 6; k < c.trajectory.nodes.size(); ++k) c.trajectory.nodes[k].q(0) += 1e-4;
       },
       {"state at phase switch", "total defect"}},
  };
}

std::vector<Sabotage> limit_sabotage() {
  return {
      {"torque over its limit",
       [](Case& c) {
         RobotDescription description = test::hyq_description();
         const double tau = c.trajectory.nodes[0].tau(2);
         description.limits["lf_kfe_joint"].torque = std::abs(tau) / 1.01;
         set_robot(c, description);
       },
       {"joint torque"}},
      {"joint out of its limits",
       [](Case& c) {
         RobotDescription description = test::hyq_description();
         description.nominal_joints["lf_kfe_joint"] = -1.6;  // only the robot's own posture, not the motion's
         description.limits["lf_kfe_joint"].position_upper = -1.5 - 2e-3;
         set_robot(c, description);
       },
       {"joint position beyond limit"}},
      {"foot slips sideways", [](Case& c) { drift(c, 1.0, 3e-3); }, {"contact drift"}},
      {"foot slips across a phase switch",  // by less than the limit in each phase
       [](Case& c) {
         split_phase(c);
         drift(c, 1.0, 2.5e-3);
       },
       {"contact drift"}},
      {"foot slips fast but not far", [](Case& c) { drift(c, 0.1, 12e-3); }, {"contact velocity"}},
      {"feet push outwards", [](Case& c) { squeeze(c, {0, 120, 0}, {1, 1, -1, -1}); }, {"friction cone"}},
      {"ground has to pull", [](Case& c) { squeeze(c, {0, 0, 220}, {1, -1, -1, 1}); }, {"unilateral force"}},
      {"planner's forces are wrong",
       [](Case& c) { c.trajectory.nodes[2].force(5) += 0.06 * c.discrete.problem.robot.weight(); },
       {"planned contact force"}},
      {"ground is 2 mm lower",
       [](Case& c) { c.discrete.problem.surfaces[0].point.z() -= 2e-3; },
       {"contact gap at closing"}},
      {"ground is 2 mm higher",
       [](Case& c) { c.discrete.problem.surfaces[0].point.z() += 2e-3; },
       {"contact gap at closing", "penetration"}},
      {"a contact that is open is in the ground",
       [](Case& c) {
         RobotDescription description = test::hyq_description();
         description.contacts.push_back({"belly", "trunk", c.trajectory.nodes[0].q(2) + 2e-3});
         set_robot(c, description);
         c.discrete.problem.phases[0].contacts.resize(4);
         for (TrajectoryPoint& node : c.trajectory.nodes) {
           node.force.conservativeResize(15);
           node.force.tail<3>().setZero();
         }
       },
       {"penetration"}},
      {"wrong torque",
       [](Case& c) {
         for (TrajectoryPoint& node : c.trajectory.nodes) node.tau(4) += 2.0;
       },
       {"local integration error", "integration error in a second", "re-integration"}},
  };
}

void expect_caught(const std::vector<Sabotage>& all) {
  for (const Sabotage& sabotage : all) {
    SCOPED_TRACE(sabotage.name);
    Case c = standing(test::hyq());
    sabotage.commit(c);
    const Certificate certificate = certify(c.discrete, c.trajectory);
    EXPECT_EQ(failed_checks(certificate), sabotage.fails);
    EXPECT_FALSE(certificate.passed);
    EXPECT_EQ(certificate.grade, CertificateGrade::failed);
  }
}

TEST(Certificate, CatchesFaultsOfTheState) { expect_caught(state_sabotage()); }
TEST(Certificate, CatchesFaultsAgainstLimits) { expect_caught(limit_sabotage()); }

TEST(Certificate, CatchesJointsThatAreTooFast) {
  Case c = crouching(test::hyq(), 400);
  RobotDescription description = test::hyq_description();
  description.limits["rh_kfe_joint"].velocity = 0.01;
  set_robot(c, description);
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_EQ(failed_checks(certificate), Names{"joint velocity"});
  EXPECT_EQ(find(certificate, "joint velocity").where, "rh_kfe_joint");
}

// Of a check that covers lengths and angles, states and rates.
TEST(Certificate, GivesTheUnitOfTheWorstValue) {
  const auto start = [](Case& c) -> BoundaryConstraint& { return c.discrete.problem.boundary_constraints[0]; };
  EXPECT_EQ(unit_of("start state", [&](Case& c) { start(c).q_ref(0) += 1e-3; }), "m");
  EXPECT_EQ(unit_of("start state", [&](Case& c) { start(c).q_ref(9) += 1e-3; }), "rad");
  EXPECT_EQ(unit_of("start state", [&](Case& c) { start(c).velocity_lower(1) += 1e-3; }), "m/s");
  EXPECT_EQ(unit_of("goal velocity", [](Case& c) { goal(c).velocity_lower(2) += 0.01; }), "m/s");
  EXPECT_EQ(unit_of("goal velocity", [](Case& c) { goal(c).velocity_lower(7) += 0.01; }), "rad/s");
  EXPECT_EQ(unit_of("joint position beyond limit", [](Case&) {}), "rad");
}

TEST(Certificate, SaysWhenAndWhere) {
  Case c = standing(test::hyq());
  c.trajectory.nodes[6].force(3 * 2) += 100.0;
  const Certificate certificate = certify(c.discrete, c.trajectory);
  const CertificateCheck& check = find(certificate, "planned contact force");
  EXPECT_NEAR(check.worst, 100.0, 1e-6);
  EXPECT_NEAR(check.time, 0.6, 1e-12);
  EXPECT_EQ(check.where, c.discrete.problem.robot.contacts()[2].name);
  EXPECT_EQ(check.unit, "N");
}

TEST(Certificate, AFlightHasNoContactChecks) {
  const RobotModel robot = test::hyq();
  Trajectory trajectory;
  for (int k = 0; k <= 100; ++k) {  // free fall from 5 m, upright, no torque: exact for the trapezoid
    TrajectoryPoint node;
    node.time = 0.002 * k;
    node.q = robot.nominal_configuration();
    node.q(2) += 5.0 - 0.5 * RobotModel::kGravity * node.time * node.time;
    node.v = node.a = Eigen::VectorXd::Zero(robot.nv());
    node.v(2) = -RobotModel::kGravity * node.time;
    node.a(2) = -RobotModel::kGravity;
    node.tau = Eigen::VectorXd::Zero(robot.nu());
    node.force = Eigen::VectorXd::Zero(12);
    trajectory.nodes.push_back(node);
  }
  MotionProblem problem = test::problem_of(robot, trajectory);
  problem.phases[0].contacts.clear();
  const Certificate certificate = certify({problem, {{PhaseMesh(100)}}}, trajectory);
  EXPECT_EQ(failed_checks(certificate), Names{});
  EXPECT_EQ(certificate.grade, CertificateGrade::certified);
  EXPECT_THROW(find(certificate, "contact drift"), std::out_of_range);
  EXPECT_LT(find(certificate, "penetration").worst, -4.0);
}

}  // namespace
}  // namespace prowl
