// Contacts that open and land, patches, and redundant contacts: each fault fails the check that is there for it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/certificate/stepping_motion.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using test::Case;
using test::failed_checks;
using test::find;
using test::Names;
using test::standing;
using test::SteppingMotion;

struct Sabotage {
  std::string name;
  std::function<void(Case&)> commit;
  Names fails;
};

Surface& patch(Case& c) { return c.discrete.problem.surfaces[1]; }

/// Surface coordinates of the patch have their origin at the foot's place.
void move_patch(Case& c, double x) {
  for (Eigen::Vector2d& corner : patch(c).patch) corner.x() += x;
}

/// A block with its wall at the given distance from the foot, on the side to which the knee moves it.
void add_block(Case& c, double distance) {
  Surface block{.name = "block", .point = patch(c).point + Eigen::Vector3d(0.0, 0.0, 0.5)};
  const double far = c.discrete.problem.robot.contacts()[0].radius + 1.0;
  block.patch = {{-far, -0.1}, {-distance, -0.1}, {-distance, 0.1}, {-far, 0.1}};
  c.discrete.problem.surfaces.push_back(block);
}

std::vector<Sabotage> landing_sabotage() {
  return {
      {"patch 2 mm lower than the foot",
       [](Case& c) {
         patch(c).point.z() -= 2e-3;
         c.discrete.problem.phases[2].contacts[0].foothold->z() -= 2e-3;
       },
       {"contact gap at closing", "contact away from its place"}},
      {"foot 2 mm beside its patch", [](Case& c) { move_patch(c, 0.032); }, {"contact outside its patch"}},
      {"foot 2 mm from its place",
       [](Case& c) { c.discrete.problem.phases[2].contacts[0].foothold->y() += 2e-3; },
       {"contact away from its place"}},
      {"swing too low", [](Case& c) { c.discrete.problem.swing_clearance = 0.2; }, {"swing clearance missing"}},
      {"foot under a plane without an edge",
       [](Case& c) { c.discrete.problem.surfaces.push_back({.name = "high", .point = {0.0, 0.0, 0.04}}); },
       {"penetration"}},
      {"feet without the load that is asked for",
       [](Case& c) { c.discrete.problem.least_load = 0.7; },
       {"least load of a held foot"}},
      {"foot in the side of a block", [](Case& c) { add_block(c, 0.0197); }, {"penetration"}},
  };
}

void expect_caught(const Sabotage& sabotage, Case c) {
  SCOPED_TRACE(sabotage.name);
  sabotage.commit(c);
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_EQ(failed_checks(certificate), sabotage.fails);
  EXPECT_EQ(certificate.grade, CertificateGrade::failed);
}

/// What may carry nothing is not asked for its load, nor what is about to open.
TEST(CertificateContacts, AsksForTheLoadOfHeldFeet) {
  Case c = SteppingMotion(test::hyq()).make();
  EXPECT_EQ(certify(c.discrete, c.trajectory).find("least load of a held foot"), nullptr);
  c.discrete.problem.least_load = 0.7;
  const Certificate asked = certify(c.discrete, c.trajectory);
  const double even = c.discrete.problem.robot.weight() / 4.0;
  EXPECT_NEAR(find(asked, "least load of a held foot").worst, 0.7 * even, 0.3 * even);
  for (Phase& phase : c.discrete.problem.phases)
    for (PhaseContact& held : phase.contacts) held.unloaded = true;
  EXPECT_EQ(failed_checks(certify(c.discrete, c.trajectory)), Names{});
}

TEST(CertificateContacts, AStepPasses) {
  const Case c = SteppingMotion(test::hyq()).make();
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_EQ(failed_checks(certificate), Names{});
  EXPECT_TRUE(certificate.passed);
  for (const char* check : {"contact gap at closing", "contact outside its patch", "contact away from its place",
                            "force before opening", "swing clearance missing"}) {
    EXPECT_NO_THROW(find(certificate, check)) << check;
  }
  EXPECT_LT(find(certificate, "swing clearance missing").worst, 0.0);
  EXPECT_NEAR(find(certificate, "force before opening").time, SteppingMotion::kShiftTime, 1e-12);
  EXPECT_THAT(certificate.redundant_contacts, testing::IsEmpty());
}

TEST(CertificateContacts, CatchesFaultsOfLanding) {
  const Case c = SteppingMotion(test::hyq()).make();
  for (const Sabotage& sabotage : landing_sabotage()) expect_caught(sabotage, c);
}

TEST(CertificateContacts, ABlockBesideTheFootIsNotInTheWay) {
  Case c = SteppingMotion(test::hyq()).make();
  add_block(c, c.discrete.problem.robot.contacts()[0].radius + 1e-3);
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_EQ(failed_checks(certificate), Names{});
}

TEST(CertificateContacts, AContactThatOpensUnderLoadFails) {
  Case c = SteppingMotion(test::hyq()).make();
  auto& nodes = c.trajectory.nodes;
  for (int k = 1; k <= SteppingMotion::kShift; ++k) {  // goes on to stand on four feet
    nodes[k].tau = nodes[0].tau;
    nodes[k].force = nodes[0].force;
  }
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_EQ(failed_checks(certificate), Names{"force before opening"});
  EXPECT_EQ(find(certificate, "force before opening").where, "lf_foot");
  EXPECT_GT(find(certificate, "force before opening").worst, 0.1 * c.discrete.problem.robot.weight());
}

TEST(CertificateContacts, AContactThatClosesWhileItMovesFails) {
  Case c = SteppingMotion(test::hyq()).make();
  constexpr int kEarly = 20;  // intervals: the contact is said to hold before the foot is there
  const double h = SteppingMotion::kSwingTime / SteppingMotion::kSwing;
  auto& nodes = c.trajectory.nodes;
  const int old_transition = SteppingMotion::kShift + SteppingMotion::kSwing + 1;  // last node of the swing
  nodes.erase(nodes.begin() + old_transition + 1);
  const int new_transition = old_transition - kEarly;
  nodes.insert(nodes.begin() + new_transition, nodes[new_transition]);
  for (std::size_t k = new_transition + 1; k < nodes.size(); ++k) nodes[k].phase = 2;
  MotionProblem problem = c.discrete.problem;
  for (auto [phase, sign] : {std::pair{1, -1}, {2, 1}}) {
    problem.phases[phase].duration.min += sign * kEarly * h;
    problem.phases[phase].duration.max = problem.phases[phase].duration.min;
  }
  c.discrete = {std::move(problem),
                {{PhaseMesh(SteppingMotion::kShift), PhaseMesh(SteppingMotion::kSwing - kEarly),
                  PhaseMesh(SteppingMotion::kShift + kEarly)}}};
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_THAT(failed_checks(certificate), testing::IsSupersetOf({"contact velocity", "contact gap at closing"}));
}

// --- Redundant contacts: Talos on two flat feet, 24 contact rows of rank 12 ---

/// Forces at the corners of the left foot, of sum and moment zero.
Eigen::VectorXd twist(const RobotModel& robot, const Eigen::Vector3d& force) {
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(robot.contacts().size()));
  const Eigen::Vector4d signs(1, -1, -1, 1);  // front left, front right, rear left, rear right
  for (int corner = 0; corner < 4; ++corner) forces.segment<3>(3 * corner) = signs(corner) * force;
  return forces;
}

Case talos_with(const Eigen::VectorXd& forces) {
  Case c = standing(test::talos());
  for (TrajectoryPoint& node : c.trajectory.nodes) node.force += forces;
  return c;
}

TEST(CertificateContacts, ForcesOfRedundantContactsAreAChoice) {
  const RobotModel robot = test::talos();
  const Case c = talos_with(twist(robot, {0.0, 0.0, 0.05 * robot.weight()}));
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_EQ(failed_checks(certificate), Names{});
  EXPECT_LT(find(certificate, "planned contact force").worst, 1e-6);
  EXPECT_EQ(certificate.redundant_contacts.size(), 8u);
  ASSERT_EQ(certificate.contact_ranks.size(), 1u);
  EXPECT_EQ(certificate.contact_ranks[0].rows, 24);
  EXPECT_EQ(certificate.contact_ranks[0].rank, 12);
}

TEST(CertificateContacts, TheChosenForcesHaveToBePossible) {
  const RobotModel robot = test::talos();
  const Case pull = talos_with(twist(robot, {0.0, 0.0, 0.2 * robot.weight()}));
  EXPECT_EQ(failed_checks(certify(pull.discrete, pull.trajectory)), Names{"unilateral force"});
  const Case slip = talos_with(twist(robot, {0.1 * robot.weight(), 0.0, 0.0}));
  EXPECT_THAT(failed_checks(certify(slip.discrete, slip.trajectory)), testing::Contains("friction cone"));
}

TEST(CertificateContacts, ForcesOfRedundantContactsThatDoNotCarryTheRobotFail) {
  const RobotModel robot = test::talos();
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(24);
  forces(2) = 0.5 * robot.weight();
  const Case c = talos_with(forces);
  EXPECT_THAT(failed_checks(certify(c.discrete, c.trajectory)), testing::Contains("planned contact force"));
}

}  // namespace
}  // namespace prowl
