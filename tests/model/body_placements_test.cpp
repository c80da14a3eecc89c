// Forward kinematics against the product of placements and turns along the tree, in Eigen alone.
#include "prowl/model/body_placements.hpp"

#include <gtest/gtest.h>

#include "prowl/model/body_tree.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

std::vector<Eigen::Isometry3d> by_hand(const BodyTree& tree, const Eigen::VectorXd& q) {
  std::vector<Eigen::Isometry3d> placements;
  for (std::size_t b = 0; b < tree.bodies.size(); ++b) {
    const RigidBody& body = tree.bodies[b];
    if (body.parent < 0) {
      placements.emplace_back(Eigen::Translation3d(base_position(q)) * base_quaternion(q));
      continue;
    }
    const double s = q(6 + static_cast<Eigen::Index>(b));
    Eigen::Isometry3d joint = Eigen::Isometry3d::Identity();
    if (body.prismatic)
      joint.translate(s * body.axis);
    else
      joint.rotate(Eigen::AngleAxisd(s, body.axis));
    placements.push_back(placements[body.parent] * body.placement * joint);
  }
  return placements;
}

TEST(BodyPlacements, AreTheProductAlongTheTree) {
  int compared = 0;
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::talos()}) {
    const BodyTree tree = body_tree(robot);
    BodyPlacements placements(robot);
    test::RandomStates states(robot, 3);
    for (int i = 0; i < 20; ++i) {
      const Eigen::VectorXd q = states.configuration();
      const auto expected = by_hand(tree, q);
      const auto& found = placements.at(q);
      ASSERT_EQ(found.size(), tree.bodies.size());
      for (std::size_t b = 0; b < found.size(); ++b) {
        EXPECT_LT((found[b].matrix() - expected[b].matrix()).norm(), 1e-12) << tree.bodies[b].name;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 1000);
}

}  // namespace
}  // namespace prowl
