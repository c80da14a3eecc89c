#include "prowl/motion/term_evaluation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prowl/error.hpp"
#include "prowl/model/body_placements.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/robot_frame.hpp"
#include "prowl/terms/selected_entries.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/terms_problem.hpp"

namespace prowl {
namespace {

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

/// Evaluates one term at any state.
class Reader {
 public:
  Reader(const RobotModel& robot, const TermUse& use) : kinematics_(robot), term_(robot, use) {}

  TermEvaluation& at(const VectorXd& q, const VectorXd& v) {
    kinematics_.update_kinematics(q);
    term_.evaluate(kinematics_, q, v);
    return term_;
  }
  VectorXd value(const VectorXd& q, const VectorXd& v) { return at(q, v).value(); }
  /// (dq | dv)
  MatrixXd slopes(const VectorXd& q, const VectorXd& v) {
    at(q, v).differentiate();
    MatrixXd both(term_.dq().rows(), 2 * v.size());
    both << term_.dq(), term_.dv();
    return both;
  }

 private:
  RigidBodyTerms kinematics_;
  TermEvaluation term_;
};

TEST(TermEvaluation, DerivativesAreThoseOfDifferences) {
  std::mt19937 rng(7);
  for (const Links& links : robots()) {
    const Eigen::Index nv = links.robot.nv();
    const DynamicsPoint at = test::random_point(links.robot, {}, rng);
    for (const TermUse& use : test::every_term(links.robot, links.tip, links.middle, 1)) {
      Reader reader(links.robot, use);
      const double h = 1e-5;
      const auto moved = [&](Eigen::Index i, double by) -> std::pair<VectorXd, VectorXd> {
        if (i < nv) return {integrate(at.q, by * VectorXd::Unit(nv, i)), at.v};
        return {at.q, at.v + by * VectorXd::Unit(nv, i - nv)};
      };
      MatrixXd expected(use.term->num_rows(), 2 * nv);
      for (Eigen::Index i = 0; i < 2 * nv; ++i) {
        const auto [q_above, v_above] = moved(i, h);
        const auto [q_below, v_below] = moved(i, -h);
        expected.col(i) = (reader.value(q_above, v_above) - reader.value(q_below, v_below)) / (2.0 * h);
      }
      const MatrixXd slopes = reader.slopes(at.q, at.v);
      EXPECT_LT(test::relative_error(slopes, expected, 1.0), 1e-7) << use.name;

      // Second derivatives along q (+) d: the tangent at a moved q is not that at q, so they are second differences.
      const VectorXd multipliers = test::random_vector(rng, use.term->num_rows(), 1.0);
      MatrixXd qq = MatrixXd::Zero(nv, nv), vq = qq, vv = qq, second(nv, nv);
      reader.slopes(at.q, at.v);
      reader.at(at.q, at.v).differentiate();
      TermEvaluation& term = reader.at(at.q, at.v);
      term.differentiate();
      term.add_hessian(multipliers, qq, vq, vv);
      const double step = 1e-3;
      const auto along = [&](const VectorXd& d) { return multipliers.dot(reader.value(integrate(at.q, d), at.v)); };
      for (Eigen::Index i = 0; i < nv; ++i) {
        for (Eigen::Index j = 0; j < nv; ++j) {
          const VectorXd s = step * (VectorXd::Unit(nv, i) + VectorXd::Unit(nv, j)),
                         d = step * (VectorXd::Unit(nv, i) - VectorXd::Unit(nv, j));
          second(i, j) = (along(s) - along(d) - along(-d) + along(-s)) / (4.0 * step * step);
        }
      }
      EXPECT_LT(test::relative_error(qq, second, 1.0), 1e-4) << use.name;
      MatrixXd by_v(2 * nv, nv);
      for (Eigen::Index i = 0; i < nv; ++i) {
        const VectorXd d = h * VectorXd::Unit(nv, i);
        by_v.col(i) =
            (reader.slopes(at.q, at.v + d) - reader.slopes(at.q, at.v - d)).transpose() * multipliers / (2.0 * h);
      }
      EXPECT_LT(test::relative_error(vq.transpose(), by_v.topRows(nv), 1.0), 1e-7) << use.name;
      EXPECT_LT(test::relative_error(vv, by_v.bottomRows(nv), 1.0), 1e-7) << use.name;
    }
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
  Broken() : Term({{Quantity::Kind::center_of_mass, ""}}, {"x"}, "-") {}
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
