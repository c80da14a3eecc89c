// A start with parts that the optimiser chooses: shipped tasks whose start is opened.
#include <gtest/gtest.h>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "tests/support/simulated_task.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;
using test::planned;

constexpr double kMet = 1e-6;  ///< [m, rad, m/s, rad/s], by far below a tolerance of the certificate

/// A shipped task that has no [start], with these lines in one.
Task with_start(const std::string& name, const std::string& lines) {
  std::string text = test::read_file(std::string(PROWL_SOURCE_DIR) + "/tasks/" + name + ".toml");
  text = test::replaced(text, "../..", PROWL_SOURCE_DIR);
  text.insert(text.find("[[phase]]"), "[start]\n" + lines + "\n");
  const test::TempFolder folder;
  return read_task_file(folder.write("task.toml", text), test::test_search());
}

struct OpenStart {
  const char *name, *task, *lines;
};

class FreeStart : public testing::TestWithParam<OpenStart> {
 protected:
  const Task task_ = with_start(GetParam().task, GetParam().lines);
  const MotionProblem& problem_ = task_.problem;
};

TEST_P(FreeStart, IsWithinItsBoundsWithContactsInPlaceAndStill) {
  const Plan plan = planned(task_);
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  const TrajectoryPoint& first = plan.trajectory.nodes.front();
  const BoundaryConstraint& start = problem_.start();
  const VectorXd offset = difference(start.q_ref, first.q);
  EXPECT_GE((offset - start.configuration_lower).minCoeff(), -kMet);
  EXPECT_GE((start.configuration_upper - offset).minCoeff(), -kMet);
  EXPECT_GE((first.v - start.velocity_lower).minCoeff(), -kMet);
  EXPECT_GE((start.velocity_upper - first.v).minCoeff(), -kMet);

  RigidBodyTerms terms(problem_.robot);
  ContactKinematics contacts(contact_indices(problem_.phases.front().contacts));
  terms.update_kinematics(start.q_ref);
  contacts.set_configuration(terms);
  const VectorXd places = contacts.positions();
  terms.update_kinematics(first.q);
  contacts.set_configuration(terms);
  EXPECT_LT((contacts.positions() - places).cwiseAbs().maxCoeff(), kMet);
  EXPECT_LT((contacts.jacobian() * first.v).cwiseAbs().maxCoeff(), kMet);
}

TEST_P(FreeStart, IsTheSameForAllSolvers) {
  const Plan own = planned(task_), ipopt = planned(task_, *make_solver("ipopt")),
             fatrop = planned(task_, *make_solver("fatrop"));
  for (const Plan* other : {&ipopt, &fatrop}) {
    ASSERT_TRUE(is_good(*other)) << other->solver << ": " << other->result.message;
    EXPECT_NEAR(other->result.cost, own.result.cost, 2e-3 * own.result.cost) << other->solver;  // meshes differ
  }
}

/// The start of the task is one of those allowed.
TEST_P(FreeStart, CostsLessThanAFixedOne) {
  const Plan fixed = planned(with_start(GetParam().task, ""));
  EXPECT_LT(planned(task_).result.cost, 0.99 * fixed.result.cost);
}

INSTANTIATE_TEST_SUITE_P(All, FreeStart,
                         testing::Values(OpenStart{"posture", "hyq/crouch",
                                                   "base_position_m = [[-0.05, 0.05], [-0.05, 0.05], [0.4, 0.6]]\n"
                                                   "base_rpy_rad = [[-0.1, 0.1], \"free\", [-0.2, 0.2]]"},
                                         OpenStart{"motion", "hyq/step",
                                                   "base_position_m = [[-0.05, 0.05], [-0.1, 0.1], \"free\"]\n"
                                                   "base_linear_velocity_mps = [[-0.3, 0.3], \"free\", \"free\"]\n"
                                                   "base_angular_velocity_radps = [\"free\", 0, 0]"},
                                         OpenStart{"redundant_contacts", "talos/squat",
                                                   "base_position_m = [[-0.02, 0.02], [-0.02, 0.02], [0.9, 1.02]]\n"
                                                   "base_rpy_rad = [[-0.05, 0.05], [-0.05, 0.05], 0]"}),
                         [](const auto& info) { return info.param.name; });

/// Robot and estimator start where the plan does, as fast as it does.
TEST(MovingStart, IsSimulated) {
  const Task task = with_start("hyq/crouch", "base_linear_velocity_mps = [0.3, 0, 0]\n");
  const Plan plan = planned(task);
  ASSERT_TRUE(is_good(plan)) << plan.result.message;
  SimulationOptions options;
  options.record_rate = 1000.0;
  options.start = StartError{};
  const SimulationResult result = test::simulated(task, plan.trajectory, options);
  EXPECT_TRUE(result.success()) << result.failures.front();
  EXPECT_LT((result.samples.front().v - plan.trajectory.nodes.front().v).cwiseAbs().maxCoeff(), kMet);
  EXPECT_LT(result.estimated_velocity.largest, 0.05);
}

}  // namespace
}  // namespace prowl
