// Links of the URDF, against urdfdom's own tree and Pinocchio's frames.
#include "prowl/model/urdf/link_tree.hpp"

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <pinocchio/algorithm/frames.hpp>

#include "prowl/model/body_placements.hpp"
#include "prowl/model/pinocchio_model.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

TEST(LinkTree, IsThatOfTheUrdf) {
  int fixed = 0, moving = 0;
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::talos()}) {
    const urdf::ModelInterfaceSharedPtr urdf = urdf::parseURDF(robot.description().urdf_text);
    const std::vector<RobotLink> links = link_tree(robot);
    ASSERT_EQ(links.size(), urdf->links_.size()) << robot.name();
    EXPECT_EQ(links[0].name, urdf->getRoot()->name);
    EXPECT_EQ(links[0].parent, -1);
    EXPECT_FALSE(links[0].fixed);
    for (std::size_t l = 1; l < links.size(); ++l) {
      const urdf::JointSharedPtr joint = urdf->getLink(links[l].name)->parent_joint;
      ASSERT_LT(links[l].parent, static_cast<int>(l)) << "parents first";
      EXPECT_EQ(links[links[l].parent].name, joint->parent_link_name) << links[l].name;
      EXPECT_EQ(links[l].fixed, joint->type == urdf::Joint::FIXED) << links[l].name;
      ++(links[l].fixed ? fixed : moving);
    }
  }
  EXPECT_GT(fixed, 10);
  EXPECT_GT(moving, 40);
}

TEST(LinkTree, PlacesLinksWherePinocchioHasThem) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::talos()}) {
    const pinocchio::Model& model = robot.pinocchio().model;
    pinocchio::Data data(model);
    const std::vector<RobotLink> links = link_tree(robot);
    BodyPlacements bodies(robot);
    test::RandomStates states(robot, 5);
    for (int i = 0; i < 10; ++i) {
      const Eigen::VectorXd q = states.configuration();
      pinocchio::framesForwardKinematics(model, data, q);
      const std::vector<Eigen::Isometry3d> placements = link_placements(links, bodies.at(q));
      ASSERT_EQ(placements.size(), links.size());
      for (std::size_t l = 0; l < links.size(); ++l) {
        const pinocchio::SE3& expected = data.oMf[model.getFrameId(links[l].name, pinocchio::BODY)];
        EXPECT_LT((placements[l].matrix() - expected.toHomogeneousMatrix()).norm(), 1e-12) << links[l].name;
      }
    }
  }
}

}  // namespace
}  // namespace prowl
