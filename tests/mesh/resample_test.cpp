#include "prowl/mesh/resample.hpp"

#include <gmock/gmock.h>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

/// Two phases, 0.4 s and 0.6 s; the second may take what `second` says.
DiscreteProblem two_phases(const Mesh& mesh, Duration second) {
  MotionProblem problem = test::standing_problem();
  problem.phases = {{.name = "first", .contacts = {}, .duration = {0.4, 0.4}},
                    {.name = "second", .contacts = {}, .duration = second}};
  return {std::move(problem), mesh};
}
DiscreteProblem two_phases(int intervals, Duration second) {
  return two_phases({{PhaseMesh(intervals), PhaseMesh(intervals)}}, second);
}

/// A motion that the trapezoid meets exactly: each phase of constant acceleration and torque of its own.
Trajectory smooth_motion(const DiscreteProblem& discrete) {
  const MotionProblem& problem = discrete.problem;
  const int nv = problem.robot.nv(), nu = problem.robot.nu();
  Trajectory motion;
  for (const MeshNode& node : discrete.nodes) {
    TrajectoryPoint point;
    point.time = node.time;
    point.phase = node.phase;
    point.a = Eigen::VectorXd::LinSpaced(nv, 0.2, 1.0) * (node.phase + 1);
    point.a.segment<3>(3).setZero();
    const double s = node.time - (node.phase == 0 ? 0.0 : 0.4);
    const Eigen::VectorXd v_start = Eigen::VectorXd::LinSpaced(nv, 0.2, 1.0) * (node.phase == 0 ? 0.0 : 0.4);
    point.v = v_start + s * point.a;
    point.v.segment<3>(3).setZero();
    const Eigen::VectorXd before =
        node.phase == 0 ? Eigen::VectorXd::Zero(nv).eval() : (0.08 * Eigen::VectorXd::LinSpaced(nv, 0.2, 1.0)).eval();
    Eigen::VectorXd way = before + s * v_start + 0.5 * s * s * point.a;
    way.segment<3>(3).setZero();
    point.q = integrate(problem.robot.nominal_configuration(), way);
    point.tau = Eigen::VectorXd::Constant(nu, 10.0 * (node.phase + 1));
    point.force = Eigen::VectorXd::Constant(12, 5.0 + node.phase);
    motion.nodes.push_back(point);
  }
  return motion;
}

TEST(Resample, IsTheSameMotionOnAnotherMesh) {
  const DiscreteProblem coarse = two_phases(3, {0.6, 0.6}), fine = two_phases(7, {0.6, 0.6});
  const Trajectory expected = smooth_motion(fine);
  const Trajectory found = resample(smooth_motion(coarse), fine);
  ASSERT_EQ(found.nodes.size(), expected.nodes.size());
  for (std::size_t k = 0; k < found.nodes.size(); ++k) {
    const TrajectoryPoint &a = found.nodes[k], &b = expected.nodes[k];
    EXPECT_EQ(a.phase, b.phase);
    EXPECT_NEAR(a.time, b.time, 1e-15);
    EXPECT_LT((a.q - b.q).norm() + (a.v - b.v).norm() + (a.a - b.a).norm(), 1e-13) << "node " << k;
    EXPECT_LT((a.tau - b.tau).norm() + (a.force - b.force).norm(), 1e-12);
  }
}

TEST(Resample, IsTheSameMotionOnUnevenMeshes) {
  const DiscreteProblem coarse = two_phases({{PhaseMesh({0.5, 0.2, 0.3}), PhaseMesh(3)}}, {0.6, 0.6});
  const DiscreteProblem fine =
      two_phases({{PhaseMesh({0.1, 0.2, 0.3, 0.4}), PhaseMesh({0.4, 0.1, 0.1, 0.4})}}, {0.6, 0.6});
  const Trajectory expected = smooth_motion(fine);
  const Trajectory found = resample(smooth_motion(coarse), fine);
  for (std::size_t k = 0; k < expected.nodes.size(); ++k) {
    EXPECT_NEAR(found.nodes[k].time, expected.nodes[k].time, 1e-15);
    EXPECT_LT((found.nodes[k].q - expected.nodes[k].q).norm() + (found.nodes[k].v - expected.nodes[k].v).norm(), 1e-13)
        << "node " << k;
  }
}

TEST(Resample, StretchesAPhaseToWhatIsAllowed) {
  const DiscreteProblem discrete = two_phases(4, {0.6, 0.6}), longer = two_phases(4, {0.9, 1.5});
  const Trajectory motion = smooth_motion(discrete);
  const Trajectory found = resample(motion, longer);
  EXPECT_DOUBLE_EQ(found.duration(), 0.4 + 0.9);
  const TrajectoryPoint &last = found.nodes.back(), &before = motion.nodes.back();
  EXPECT_LT((last.q - before.q).norm(), 1e-15);
  EXPECT_LT((1.5 * last.v - before.v).norm() + (1.5 * 1.5 * last.a - before.a).norm(), 1e-13);
  EXPECT_EQ(last.tau, before.tau);
}

TEST(Resample, RefusesAMotionOfAnotherProblem) {
  const DiscreteProblem discrete = two_phases(4, {0.6, 0.6});
  const Trajectory motion = smooth_motion(discrete);
  const auto message = [&](const Trajectory& other) -> std::string {
    try {
      resample(other, discrete);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  Trajectory one_phase = motion;
  one_phase.nodes.resize(5);
  EXPECT_EQ(message(one_phase), "the motion to start from has 1 phases, the task 2");
  Trajectory other_robot = motion;
  other_robot.nodes[3].tau.conservativeResize(8);
  EXPECT_EQ(message(other_robot), "the motion to start from is of another robot");
  Trajectory cut = motion;
  cut.nodes.resize(6);
  EXPECT_EQ(message(cut), "the motion to start from has no interval in phase 2");
}

}  // namespace
}  // namespace prowl
