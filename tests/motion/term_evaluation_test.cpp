#include "prowl/motion/term_evaluation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prowl/error.hpp"
#include "prowl/model/body_placements.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/robot_frame.hpp"
#include "prowl/terms/own_term.hpp"
#include "prowl/terms/selected_entries.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/terms_problem.hpp"

namespace prowl {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct Links {
  RobotModel robot;
  const char *tip, *middle;
};

std::vector<Links> robots() {
  return {{test::hyq(), "lf_foot", "rh_upperleg"}, {test::talos(), "gripper_left_base_link", "torso_2_link"}};
}

/// All variables of a node, with forces that follow from them.
struct State {
  VectorXd q, v, a, tau;

  VectorXd forces() const { return force_map * (VectorXd(3 * v.size() + tau.size()) << kept, v, a, tau).finished(); }
  /// Displaced in one variable: in the tangent of q | v | a | tau.
  State moved(const VectorXd& by) const {
    const Index nv = v.size();
    State result = *this;
    result.q = integrate(q, by.head(nv));
    result.v += by.segment(nv, nv);
    result.a += by.segment(2 * nv, nv);
    result.tau += by.tail(tau.size());
    result.kept += by.head(nv);
    return result;
  }
  Index size() const { return 3 * v.size() + tau.size(); }

  MatrixXd force_map;  ///< of the contacts whose forces are known
  VectorXd kept;       ///< how far q was displaced
};

/// Evaluates one term at any state.
class Reader {
 public:
  Reader(const RobotModel& robot, const TermUse& use, const std::vector<int>& contacts = {})
      : kinematics_(robot), term_(robot, use, contacts) {}

  TermEvaluation& at(const VectorXd& q, const VectorXd& v, const VectorXd& tau = {}, const VectorXd& forces = {}) {
    kinematics_.update_kinematics(q);
    term_.evaluate({kinematics_, q, v, tau, forces, 0.7});
    return term_;
  }
  TermEvaluation& at(const State& state) { return at(state.q, state.v, state.tau, state.forces()); }
  VectorXd value(const VectorXd& q, const VectorXd& v) { return at(q, v).value(); }
  VectorXd value(const State& state) { return at(state).value(); }
  /// In all variables.
  MatrixXd slopes(const State& state) {
    TermEvaluation& term = at(state);
    term.differentiate(state.force_map);
    MatrixXd all = MatrixXd::Zero(term.dx().rows(), state.size());
    all.middleCols(term.first_variable(), term.dx().cols()) = term.dx();
    return all;
  }

 private:
  RigidBodyTerms kinematics_;
  TermEvaluation term_;
};

/// Forces are linear in the variables here: their own second derivatives are those of the dynamics, tested there.
TEST(TermEvaluation, DerivativesAreThoseOfDifferences) {
  std::mt19937 rng(7);
  for (const Links& links : robots()) {
    const RobotModel& robot = links.robot;
    const Index nv = robot.nv(), all = 3 * nv + robot.nu();
    const std::vector<int> contacts = {2, 0};
    const DynamicsPoint point = test::random_point(robot, contacts, rng);
    const State state{point.q, point.v, point.a, point.tau, test::random_matrix(rng, 6, all, 1.0), VectorXd::Zero(nv)};
    for (const TermUse& use : test::every_term(robot, links.tip, links.middle, 1)) {
      Reader reader(robot, use, contacts);
      const double h = 1e-5;
      MatrixXd expected(use.term->num_rows(), all);
      for (Index i = 0; i < all; ++i) {
        const VectorXd step = h * VectorXd::Unit(all, i);
        expected.col(i) = (reader.value(state.moved(step)) - reader.value(state.moved(-step))) / (2.0 * h);
      }
      EXPECT_LT(test::relative_error(reader.slopes(state), expected, 1.0), 1e-6) << use.name;

      // Second derivatives along q (+) d: the tangent at a moved q is not that at q, so they are second differences.
      const VectorXd multipliers = test::random_vector(rng, use.term->num_rows(), 1.0);
      MatrixXd hessian = MatrixXd::Zero(all, all), second(all, all);
      reader.slopes(state);
      TermEvaluation& term = reader.at(state);
      term.differentiate(state.force_map);
      term.add_hessian(multipliers, hessian);
      const double step = 1e-3;
      const auto along = [&](const VectorXd& d) { return multipliers.dot(reader.value(state.moved(d))); };
      for (Index i = 0; i < all; ++i) {
        for (Index j = 0; j < all; ++j) {
          const VectorXd s = step * (VectorXd::Unit(all, i) + VectorXd::Unit(all, j)),
                         d = step * (VectorXd::Unit(all, i) - VectorXd::Unit(all, j));
          second(i, j) = (along(s) - along(d) - along(-d) + along(-s)) / (4.0 * step * step);
        }
      }
      EXPECT_LT(test::relative_error(hessian, second, 1.0), 1e-4) << use.name;
    }
  }
}

/// What the second derivatives of the forces are multiplied with.
TEST(TermEvaluation, PullOnForcesIsTheDerivativeInThem) {
  std::mt19937 rng(10);
  const RobotModel robot = test::hyq();
  const std::vector<int> contacts = {2, 0};
  const DynamicsPoint at = test::random_point(robot, contacts, rng);
  const VectorXd forces = test::random_vector(rng, 6, 100.0);
  for (const TermUse& use : test::every_term(robot, "lf_foot", "rh_upperleg", 1)) {
    Reader reader(robot, use, contacts);
    const VectorXd multipliers = test::random_vector(rng, use.term->num_rows(), 1.0);
    VectorXd pull = VectorXd::Zero(6), expected(6);
    TermEvaluation& term = reader.at(at.q, at.v, at.tau, forces);
    term.differentiate(MatrixXd::Zero(6, 3 * robot.nv() + robot.nu()));
    term.add_force_pull(multipliers, pull);
    for (Index i = 0; i < 6; ++i) {
      const VectorXd step = 1e-3 * VectorXd::Unit(6, i);
      const auto with = [&](const VectorXd& moved) {
        return multipliers.dot(reader.at(at.q, at.v, at.tau, moved).value());
      };
      expected(i) = (with(forces + step) - with(forces - step)) / 2e-3;
    }
    EXPECT_LT((pull - expected).norm(), 1e-7 * (1.0 + expected.norm())) << use.name;
  }
}

TEST(TermEvaluation, ReadsThePlacementsOfPinocchio) {
  std::mt19937 rng(8);
  for (const Links& links : robots()) {
    const DynamicsPoint at = test::random_point(links.robot, {}, rng);
    BodyPlacements placements(links.robot);
    const std::vector<Eigen::Isometry3d> bodies = placements.at(at.q);
    const RobotFrame tip = robot_frame(links.robot, links.tip);
    const Eigen::Isometry3d tip_in_world = bodies[tip.body] * tip.placement;
    Reader position(links.robot, test::limit_on("", frame_position(links.tip), 0.0, 0.0));
    EXPECT_LT((position.value(at.q, at.v) - tip_in_world.translation()).norm(), 1e-12);
    Reader orientation(links.robot, test::limit_on("", frame_orientation(links.tip, tip_in_world.linear()), 0.0, 0.0));
    EXPECT_LT(orientation.value(at.q, at.v).norm(), 1e-12);
    Vector3d sum = Vector3d::Zero();
    const BodyTree tree = body_tree(links.robot);
    for (std::size_t b = 0; b < bodies.size(); ++b) sum += tree.bodies[b].mass * (bodies[b] * tree.bodies[b].center);
    Reader center(links.robot, test::limit_on("", center_of_mass(), 0.0, 0.0));
    EXPECT_LT((center.value(at.q, at.v) - sum / links.robot.mass()).norm(), 1e-12);
  }
}

/// Velocities against differences of positions along the motion.
TEST(TermEvaluation, RatesAreThoseOfThePositions) {
  std::mt19937 rng(9);
  for (const Links& links : robots()) {
    const DynamicsPoint at = test::random_point(links.robot, {}, rng);
    const double h = 1e-6;
    VectorXd rate = at.v;  // in the tangent of q
    rate.head<3>() = base_rotation(at.q) * at.v.head<3>();
    const auto difference = [&](const std::shared_ptr<const Term>& term) -> VectorXd {
      Reader reader(links.robot, test::limit_on("", term, 0.0, 0.0));
      return (reader.value(integrate(at.q, h * rate), at.v) - reader.value(integrate(at.q, -h * rate), at.v)) /
             (2.0 * h);
    };
    const auto value = [&](const std::shared_ptr<const Term>& term) {
      return Reader(links.robot, test::limit_on("", term, 0.0, 0.0)).value(at.q, at.v);
    };
    EXPECT_LT((value(frame_velocity(links.tip)) - difference(frame_position(links.tip))).norm(), 1e-7);
    EXPECT_LT((value(center_of_mass_velocity()) - difference(center_of_mass())).norm(), 1e-7);
    // From where the frame is, its rotation vector grows with the angular velocity in the frame.
    BodyPlacements placements(links.robot);
    const RobotFrame tip = robot_frame(links.robot, links.tip);
    const Eigen::Matrix3d R = placements.at(at.q)[tip.body].linear() * tip.placement.linear();
    const VectorXd turning = R * difference(frame_orientation(links.tip, R));
    EXPECT_LT((value(frame_angular_velocity(links.tip)) - turning).norm(), 1e-7);
  }
}

/// A term of a user that divides by zero.
class Broken : public Term {
 public:
  Broken() : Term({{.kind = Quantity::Kind::center_of_mass}}, {"x"}, "-") {}
  void value(const VectorXd& /*y*/, Eigen::Ref<VectorXd> f) const override { f(0) = std::nan(""); }
  void jacobian(const VectorXd& /*y*/, Eigen::Ref<MatrixXd> f_y) const override { f_y.setZero(); }
  void hessian(const VectorXd& /*y*/, const VectorXd& /*multipliers*/, Eigen::Ref<MatrixXd> f_yy) const override {
    f_yy.setZero();
  }
};

TEST(TermEvaluation, NamesATermThatIsNotFinite) {
  const RobotModel robot = test::hyq();
  Reader reader(robot, test::limit_on("broken", std::make_shared<Broken>(), 0.0, 0.0));
  try {
    reader.value(robot.nominal_configuration(), VectorXd::Zero(robot.nv()));
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_EQ(std::string(error.what()), "term 'broken': its value is not finite");
  }
}

/// The size of a force has no derivative at zero, where an open contact stays.
TEST(TermEvaluation, TakesTheSizeOfAForceThatIsNotThere) {
  std::mt19937 rng(11);
  const RobotModel robot = test::hyq();
  const auto size = own_term<3, 1>({{Quantity::Kind::force, robot.contacts()[1].name}}, {"size"}, "N",
                                   [](const auto& y, auto& f) { f(0) = y.norm(); });
  const TermUse use = test::limit_on("size", size, 0.0, 500.0);
  const DynamicsPoint at = test::random_point(robot, {}, rng);
  const Index all = 3 * robot.nv() + robot.nu();
  Reader reader(robot, use, {0});
  TermEvaluation& term = reader.at(at.q, at.v, at.tau, Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(term.value()(0), 0.0);
  term.differentiate(MatrixXd::Zero(3, all));
  MatrixXd hessian = MatrixXd::Zero(all, all);
  term.add_hessian(VectorXd::Ones(1), hessian);
  EXPECT_TRUE(term.dx().isZero(0.0) && hessian.isZero(0.0));
}

TEST(RobotFrame, NamesTheNearestLink) {
  const RobotModel robot = test::hyq();
  EXPECT_EQ(robot_frame(robot, "base").body, 0);
  EXPECT_GT(robot_frame(robot, "lf_foot").body, 0);
  try {
    robot_frame(robot, "lf_fot");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), "robot 'HyQ' has no link 'lf_fot'; did you mean 'lf_foot'?");
  }
}

}  // namespace
}  // namespace prowl
