// Flat feet: eight corner points of Talos's two soles, 24 rows of rank 12. The forces of single corners are a choice,
// the motion is not: it has to be that of six rows a foot.
#include <gtest/gtest.h>

#include <limits>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody/data.hpp>

#include "prowl/guess/initial_guess.hpp"
#include "prowl/model/pinocchio_model.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/transcription/transcription.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Talos with these points on each sole, grippers away from their limits: a limit that is just touched moves the
/// solution of an interior-point method by the root of its tolerance.
RobotModel talos(const std::vector<Eigen::Vector3d>& points) {
  RobotDescription robot = test::talos_description();
  robot.nominal_joints["gripper_left_joint"] = robot.nominal_joints["gripper_right_joint"] = -0.5;
  robot.contacts.clear();
  for (const char* side : {"left", "right"}) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      robot.contacts.push_back(
          {side + std::string("_") + std::to_string(i), side + std::string("_sole_link"), 0.0, points[i]});
    }
  }
  return RobotModel(robot);
}

const std::vector<Eigen::Vector3d> kCorners = {
    {0.095, 0.061, 0.0}, {0.095, -0.061, 0.0}, {-0.105, 0.061, 0.0}, {-0.105, -0.061, 0.0}};
const std::vector<Eigen::Vector3d> kMiddlesOfEdges = {
    {-0.005, 0.061, 0.0}, {0.095, 0.0, 0.0}, {-0.105, 0.0, 0.0}, {-0.005, -0.061, 0.0}};

/// 5 cm down in a second, at rest at the end. No force cost; the friction is far more than it needs.
MotionProblem squat(RobotModel robot) {
  MotionProblem problem = test::standing_problem(std::move(robot), 0.0, 1.0);
  problem.phases[0].duration = {1.0, 1.0};
  problem = test::with_base_goal(problem, {0.0, 0.0, -0.05});
  problem.boundary_constraints[1].velocity_lower.head<6>().setZero();
  problem.boundary_constraints[1].velocity_upper.head<6>().setZero();
  QuadraticCost& cost = problem.running_cost;
  cost.configuration_weight.setConstant(0.1);
  cost.velocity_weight.setConstant(0.1);
  cost.acceleration_weight.setConstant(0.01);
  cost.acceleration_weight.head<6>().setOnes();
  cost.torque_weight.setConstant(1e-4);
  return problem;
}

/// The same program on a basis of six rows a foot: the forces of the dependent rows are zero, so that those of the
/// other twelve are the two wrenches in other coordinates. Cones of single points have no meaning then and are left
/// out.
class SixRowsAFoot : public StoredNlp {
 public:
  explicit SixRowsAFoot(Transcription& nlp) : StoredNlp(nlp), nlp_(nlp) {
    for (int i = 0; i < num_variables(); ++i) {
      if (nlp.describe_variable(i).find(", force ") == std::string::npos) continue;
      variable_lower_(i) = variable_upper_(i) = 0.0;
      ++num_chosen;
    }
    for (int i = 0; i < num_constraints(); ++i) {
      if (nlp.describe_constraint(i).find("friction cone") == std::string::npos) continue;
      constraint_lower_(i) = -std::numeric_limits<double>::infinity();
      ++num_cones;
    }
  }
  int num_chosen = 0, num_cones = 0;

  double cost(const VectorXd& z) override { return nlp_.cost(z); }
  void cost_gradient(const VectorXd& z, Eigen::Ref<VectorXd> gradient) override { nlp_.cost_gradient(z, gradient); }
  void constraints(const VectorXd& z, Eigen::Ref<VectorXd> g) override { nlp_.constraints(z, g); }
  void jacobian(const VectorXd& z, Eigen::Ref<VectorXd> values) override { nlp_.jacobian(z, values); }
  void hessian(const VectorXd& z, double cost_factor, const VectorXd& multipliers,
               Eigen::Ref<VectorXd> values) override {
    nlp_.hessian(z, cost_factor, multipliers, values);
  }
  std::string describe_constraint(int row) const override { return nlp_.describe_constraint(row); }
  std::string describe_variable(int index) const override { return nlp_.describe_variable(index); }

 private:
  Transcription& nlp_;
};

struct Solved {
  SolveResult result;
  Trajectory motion;
};

Solved solve(const MotionProblem& problem, bool on_six_rows = false, double tolerance = 1e-9) {
  const DiscreteProblem discrete = test::on_even_mesh(problem, 8);
  const Trajectory guess = initial_guess(discrete);
  Transcription nlp(discrete, guess);
  SolverOptions options;
  options.tolerance = tolerance;
  Solved solved;
  if (on_six_rows) {
    SixRowsAFoot six(nlp);
    EXPECT_EQ(six.num_chosen, 12 * discrete.num_nodes());
    EXPECT_EQ(six.num_cones, 8 * discrete.num_nodes());
    solved.result = IpoptSolver().solve(six, nlp.pack(guess), options);
  } else {
    solved.result = IpoptSolver().solve(nlp, nlp.pack(guess), options);
  }
  EXPECT_EQ(solved.result.status, SolveStatus::converged) << solved.result.message;
  solved.motion = nlp.unpack(solved.result.z);
  return solved;
}

void expect_same_motion(const Trajectory& one, const Trajectory& other, double tolerance) {
  ASSERT_EQ(one.nodes.size(), other.nodes.size());
  for (std::size_t k = 0; k < one.nodes.size(); ++k) {
    EXPECT_LT((one.nodes[k].q - other.nodes[k].q).cwiseAbs().maxCoeff(), tolerance) << "q, node " << k;
    EXPECT_LT((one.nodes[k].v - other.nodes[k].v).cwiseAbs().maxCoeff(), tolerance) << "v, node " << k;
    EXPECT_LT((one.nodes[k].tau - other.nodes[k].tau).cwiseAbs().maxCoeff(), tolerance) << "tau, node " << k;
  }
}

class FlatFeet : public testing::Test {
 protected:
  const MotionProblem problem_ = squat(talos(kCorners));
  const Solved corners_ = solve(problem_);
};

TEST_F(FlatFeet, SquatWithoutDampingInFewIterations) {
  EXPECT_LT(corners_.result.iterations, 30);
  EXPECT_LT(corners_.result.constraint_violation, 1e-9);
  for (const TrajectoryPoint& node : corners_.motion.nodes) {
    for (int c = 0; c < 8; ++c) {
      const Eigen::Vector3d force = node.force.segment<3>(3 * c);
      EXPECT_GT(force.z() - force.head<2>().norm(), 0.02 * problem_.robot.weight()) << "friction is to be inactive";
    }
  }
}

TEST_F(FlatFeet, MoveAsOnSixRowsAFoot) { expect_same_motion(corners_.motion, solve(problem_, true).motion, 1e-6); }

TEST_F(FlatFeet, MoveAsOnOtherPointsOfTheSoles) {
  constexpr double kTolerance = 1e-10;  // other cones, another barrier: that of 1e-9 moves torques by 1.1e-6 N m
  const Trajectory corners = solve(problem_, false, kTolerance).motion;
  expect_same_motion(corners, solve(squat(talos({kCorners.rbegin(), kCorners.rend()})), false, kTolerance).motion,
                     1e-6);
  expect_same_motion(corners, solve(squat(talos(kMiddlesOfEdges)), false, kTolerance).motion, 1e-6);
}

/// With Pinocchio's own six-row Jacobians: what the torques leave over is a wrench on each foot, and it is that of its
/// corners.
TEST_F(FlatFeet, ForcesOfTheCornersAreTheWrenchesOfTheFeet) {
  const pinocchio::Model& model = problem_.robot.pinocchio().model;
  pinocchio::Data data(model);
  const double weight = problem_.robot.weight();
  const int nv = problem_.robot.nv();
  for (const TrajectoryPoint& node : corners_.motion.nodes) {
    VectorXd left_over = pinocchio::rnea(model, data, node.q, node.v, node.a);
    left_over.tail(nv - 6) -= node.tau;
    pinocchio::computeJointJacobians(model, data, node.q);
    pinocchio::updateFramePlacements(model, data);
    Eigen::MatrixXd J(12, nv);
    VectorXd of_corners = VectorXd::Zero(12);
    for (int foot = 0; foot < 2; ++foot) {
      const auto sole = model.getFrameId(foot == 0 ? "left_sole_link" : "right_sole_link");
      Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6, nv);
      pinocchio::getFrameJacobian(model, data, sole, pinocchio::LOCAL_WORLD_ALIGNED, rows);
      J.middleRows<6>(6 * foot) = rows;
      for (int i = 0; i < 4; ++i) {
        const Eigen::Vector3d force = node.force.segment<3>(12 * foot + 3 * i);
        const Eigen::Vector3d arm = data.oMf[sole].rotation() * kCorners[i];
        of_corners.segment<3>(6 * foot) += force;
        of_corners.segment<3>(6 * foot + 3) += arm.cross(force);
      }
    }
    const VectorXd wrenches = J.transpose().colPivHouseholderQr().solve(left_over);
    EXPECT_LT((J.transpose() * wrenches - left_over).norm(), 1e-7 * weight);
    EXPECT_LT((wrenches - of_corners).norm(), 1e-7 * weight);
  }
}

}  // namespace
}  // namespace prowl
