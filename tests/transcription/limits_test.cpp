// What may give way in an elastic solve: every such limit is found, once, and called by its name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "prowl/guess/initial_guess.hpp"
#include "prowl/motion/friction_cone.hpp"
#include "prowl/transcription/motion_limits.hpp"
#include "prowl/transcription/transcription.hpp"
#include "tests/support/everything_problem.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

class Limits : public testing::Test {
 protected:
  Limits() {
    RobotDescription description = test::hyq_description();
    description.limits["lf_kfe_joint"].torque_over_position = {
        {-2.5, 70.0}, {-2.0, 120.0}, {-1.4, 145.0}, {-1.0, 130.0}, {-0.3, 70.0}};
    description.limits["lf_kfe_joint"].negative_torque_over_position = {
        {-2.5, 40.0}, {-2.0, 70.0}, {-1.4, 85.0}, {-1.0, 80.0}, {-0.3, 40.0}};
    auto [problem, mesh] =
        test::everything(RobotModel(description),
                         {test::phase_on("four", {0, 1, 2, 3}, 0.4, 2), test::phase_on("swing", {1, 2, 3}, 0.4, 4),
                          test::phase_on("down", {0, 1, 2, 3}, 0.4, 2)},
                         Surface{});
    problem.swing_clearance = 0.05;
    problem.phases[2].contacts[0].foothold = Eigen::Vector3d(0.45, 0.32, 0.0);
    discrete_.emplace(problem, mesh);
    const Trajectory guess = initial_guess(*discrete_);
    nlp_.emplace(*discrete_, guess);
    z_ = nlp_->pack(guess);
  }

  const MotionProblem& problem() const { return discrete_->problem; }

  std::optional<DiscreteProblem> discrete_;
  std::optional<Transcription> nlp_;
  Eigen::VectorXd z_;
};

TEST_F(Limits, AreEachThereOnceWithABoundAndItsName) {
  std::set<std::pair<bool, int>> seen;
  std::map<LimitKind, int> count;
  for (const MotionLimit& limit : motion_limits(nlp_->nodes())) {
    EXPECT_TRUE(seen.insert({limit.is_row, limit.index}).second) << limit.subject;
    ++count[limit.kind];
    const double lower = limit.is_row ? nlp_->constraint_lower()(limit.index) : nlp_->variable_lower()(limit.index);
    const double upper = limit.is_row ? nlp_->constraint_upper()(limit.index) : nlp_->variable_upper()(limit.index);
    EXPECT_TRUE(std::isfinite(lower) || std::isfinite(upper)) << limit.subject;
    EXPECT_TRUE(limit.size > 0.0 && std::isfinite(limit.size) && limit.si > 0.0) << limit.subject;
    const std::string words =
        limit.is_row ? nlp_->describe_constraint(limit.index) : nlp_->describe_variable(limit.index);
    if (limit.kind != LimitKind::goal) EXPECT_THAT(words, HasSubstr(limit.subject));
    EXPECT_THAT(words, HasSubstr("phase " + std::to_string(limit.phase + 1)));
    if (limit.kind == LimitKind::friction) EXPECT_THAT(words, HasSubstr("friction cone"));
    if (limit.kind == LimitKind::clearance) EXPECT_THAT(words, HasSubstr("clearance"));
  }
  const int nodes = 3 + 5 + 3, nu = problem().robot.nu();
  EXPECT_EQ(count[LimitKind::friction], 3 * 4 - 1 + 5 * 3 + 3 * 4) << "a foot that opens has a force of zero there";
  EXPECT_EQ(count[LimitKind::torque], nodes * nu + 2 * nodes) << "the curve has a row for each side";
  EXPECT_EQ(count[LimitKind::joint_position], (nodes - 1) * nu) << "the start is as it is";
  EXPECT_EQ(count[LimitKind::joint_velocity], (nodes - 1) * nu);
  EXPECT_EQ(count[LimitKind::goal], 6) << "the pose of the base";
  EXPECT_EQ(count[LimitKind::foothold], 2);
  EXPECT_GE(count[LimitKind::clearance], 3);
}

/// A row or variable times si is what its unit says.
TEST_F(Limits, AreInTheirUnits) {
  Eigen::VectorXd g(nlp_->num_constraints());
  nlp_->constraints(z_, g);
  const Trajectory motion = nlp_->unpack(z_);
  int looked_at = 0, upper = 0, lower = 0;
  for (const MotionLimit& limit : motion_limits(nlp_->nodes())) {
    const TrajectoryPoint& point = motion.nodes[limit.node];
    if (limit.kind == LimitKind::friction) {
      const int contact = problem().robot.contact_index(limit.subject);
      const Eigen::Vector3d force = point.force.segment<3>(3 * contact);
      const double friction = problem().surfaces[0].friction;
      const Phase& phase = problem().phases[limit.phase];
      const FrictionCone cone{.mu = friction, .smoothing = cone_smoothing(problem(), phase, phase.contacts.front())};
      EXPECT_NEAR(g(limit.index) * limit.si, cone.value(force), 1e-6) << limit.subject;
      ++looked_at;
    } else if (limit.kind == LimitKind::torque && limit.is_row) {
      const RobotModel& robot = problem().robot;
      const double most = robot.torque_curves()[0].positive.value(point.q(9)),
                   least = -robot.torque_curves()[0].negative.value(point.q(9)),
                   motor = point.tau(2) + robot.losses().torque(2, point.v(8)), left = g(limit.index) * limit.si;
      const bool is_upper = std::abs(left - (most - motor)) < 1e-9;
      EXPECT_TRUE(is_upper || std::abs(left - (motor - least)) < 1e-9)
          << left << " of " << least << " to " << most << " and " << motor;
      ++(is_upper ? upper : lower);
    }
  }
  EXPECT_GT(looked_at, 20);
  EXPECT_GT(upper, 3);
  EXPECT_EQ(upper, lower);
}

}  // namespace
}  // namespace prowl
