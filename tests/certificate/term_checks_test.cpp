#include "prowl/certificate/term_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/motion/term_evaluation.hpp"
#include "tests/certificate/certificate_cases.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/terms_problem.hpp"

namespace prowl {
namespace {

using test::Case;
using test::failed_checks;
using test::find;
using test::Names;

/// A crouch that leans and turns, with a limit of one term at its planned values of one node.
class TermChecksTest : public testing::Test {
 protected:
  Eigen::VectorXd planned(const TermUse& use, std::size_t node) {
    const TrajectoryPoint& point = case_.trajectory.nodes[node];
    RigidBodyTerms kinematics(robot());
    TermEvaluation term(robot(), use, {0, 1, 2, 3});
    kinematics.update_kinematics(point.q);
    term.evaluate({kinematics, point.q, point.v, point.tau, point.force});
    return term.value();
  }
  TermUse exact(const std::shared_ptr<const Term>& term, std::size_t node) {
    TermUse use = test::limit_on("mine", term, 0.0, 0.0);
    use.lower = use.upper = planned(use, node);
    const double last = static_cast<double>(case_.trajectory.nodes.size()) - 1.0;
    use.from = use.to = {0, static_cast<double>(node) / last};
    return use;
  }
  Certificate with(const TermUse& use) {
    case_.discrete.problem.terms = {use};
    return certify(case_.discrete, case_.trajectory);
  }
  const RobotModel& robot() const { return case_.discrete.problem.robot; }

  Case case_ = test::crouching(test::hyq(), 40);
};

/// Everything that a term can read, by the certificate's kinematics, is what the planner's gives.
TEST_F(TermChecksTest, ReadWhatThePlannerReads) {
  for (const TermUse& use : test::every_term(robot(), "lf_foot", "rh_upperleg", 1)) {
    const Certificate certificate = with(exact(use.term, 17));
    // Of the true forces only nearly: this motion has been interpolated.
    const double allowed = reads_loads(*use.term) ? 1e-5 * robot().weight() : 1e-10;
    EXPECT_NEAR(find(certificate, "term 'mine'").worst, 0.0, allowed) << use.name;
    EXPECT_EQ(find(certificate, "term 'mine'").unit, use.term->unit());
  }
}

TEST_F(TermChecksTest, FindOneThatIsBeyondItsBound) {
  TermUse use = exact(frame_position("lf_upperleg"), 20);
  use.lower(2) += 0.002;  // twice the tolerance
  use.upper(2) += 0.003;
  Names expected = failed_checks(certify(case_.discrete, case_.trajectory));
  expected.insert("term 'mine'");
  const Certificate certificate = with(use);
  EXPECT_EQ(failed_checks(certificate), expected);
  EXPECT_NEAR(find(certificate, "term 'mine'").worst, 0.002, 1e-9);
  EXPECT_EQ(find(certificate, "term 'mine'").where, "z");
  EXPECT_NEAR(find(certificate, "term 'mine'").time, 1.0, 1e-9);
}

/// The base is highest at both ends: a bound at its height at one node is broken on one side of it, from the first
/// sample on.
TEST_F(TermChecksTest, LookBetweenTheNodesOfTheSpan) {
  TermUse use = exact(frame_position("base"), 10);
  use.lower.setConstant(-9.0);
  use.upper.head<2>().setConstant(9.0);
  use.to = {0, 0.75};
  EXPECT_NEAR(find(with(use), "term 'mine'").worst, 0.0, 1e-9);
  use.to = use.from;
  use.from = {0, 0.225};
  const CertificateCheck check = find(with(use), "term 'mine'");
  EXPECT_GT(check.worst, 1e-6);
  EXPECT_NEAR(check.time, 0.225 * case_.trajectory.duration(), 1e-9);
}

/// Times that a file rounds do not lose a moment.
TEST_F(TermChecksTest, FindAMomentByItsNode) {
  TermUse use = exact(frame_position("base"), 13);
  use.lower.array() += 0.01;
  use.upper.array() += 0.01;
  for (TrajectoryPoint& node : case_.trajectory.nodes) node.time += 1e-8 * std::sin(100.0 * node.time);
  EXPECT_NEAR(find(with(use), "term 'mine'").worst, 0.01, 1e-9);
}

TEST_F(TermChecksTest, AreNoneForCosts) {
  EXPECT_EQ(with(test::cost_on("mine", center_of_mass(), 1.0, 0.0)).find("term 'mine'"), nullptr);
}

}  // namespace
}  // namespace prowl
