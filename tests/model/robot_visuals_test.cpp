// What a robot looks like, held against what it weighs and where it touches.
#include "prowl/model/urdf/robot_visuals.hpp"

#include <gmock/gmock.h>

#include <set>

#include "tests/support/robots.hpp"

namespace prowl {
namespace {

TEST(RobotVisuals, HyqHasItsMeshesOnTheRightBodies) {
  const RobotModel robot = test::hyq();
  const BodyTree tree = body_tree(robot);
  std::map<std::string, int> meshes;
  for (const RobotVisual& visual : robot_visuals(robot)) {
    if (visual.kind != RobotVisual::Kind::mesh) continue;
    ++meshes[visual.mesh.substr(visual.mesh.rfind('/') + 1)];
    const std::string& joint = tree.bodies[visual.body].name;
    const std::map<std::string, std::string> behind = {
        {"hipassembly", "haa_joint"}, {"upperleg", "hfe_joint"}, {"lowerleg", "kfe_joint"}, {"trunk", "base"}};
    const std::string part = visual.link == "trunk" ? "trunk" : visual.link.substr(3);
    EXPECT_THAT(joint, testing::EndsWith(behind.at(part))) << visual.link;
    EXPECT_EQ(visual.link == "trunk" ? "ba" : visual.link.substr(0, 2), joint.substr(0, 2));
  }
  EXPECT_EQ(meshes, (std::map<std::string, int>{
                        {"hipassembly.dae", 4}, {"upperleg.dae", 4}, {"lowerleg.dae", 4}, {"trunk.dae", 1}}));
}

TEST(RobotVisuals, BallsOfTheFeetAreWhereTheContactsAre) {
  const RobotModel robot = test::hyq();
  const BodyTree tree = body_tree(robot);
  int feet = 0;
  for (const RobotVisual& visual : robot_visuals(robot)) {
    if (visual.kind != RobotVisual::Kind::sphere) continue;
    const int contact = robot.contact_index(visual.link);
    const BodyTree::Point& point = tree.points[contact];
    EXPECT_EQ(visual.body, point.body);
    EXPECT_LT((visual.placement.translation() - point.position).norm(), 1e-12);
    EXPECT_EQ(visual.size.x(), robot.contacts()[contact].radius);
    ++feet;
  }
  EXPECT_EQ(feet, 4);
}

TEST(RobotVisuals, AnInertiaBoxHasTheBodysInertia) {
  int compared = 0;
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12()}) {
    const BodyTree tree = body_tree(robot);
    for (std::size_t b = 0; b < tree.bodies.size(); ++b) {
      const RigidBody& body = tree.bodies[b];
      const auto box = inertia_box(tree, static_cast<int>(b));
      ASSERT_TRUE(box.has_value());
      const Eigen::Vector3d squares = box->size.cwiseAbs2();
      const Eigen::Vector3d moments = body.mass / 12.0 * (Eigen::Vector3d::Constant(squares.sum()) - squares);
      const Eigen::Matrix3d R = box->placement.linear();
      EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
      EXPECT_LT((R * moments.asDiagonal() * R.transpose() - body.inertia).norm(), 1e-9 * body.inertia.norm())
          << body.name;
      EXPECT_EQ(box->placement.translation(), body.center);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 3 * 13);
}

}  // namespace
}  // namespace prowl
