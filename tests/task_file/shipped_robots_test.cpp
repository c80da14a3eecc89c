#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

/// The robot files that come with Prowl, and what the tests of the other layers use in their place.
struct Shipped {
  const char* file;
  RobotDescription (*expected)();
};

void PrintTo(const Shipped& robot, std::ostream* out) { *out << robot.file; }

class ShippedRobot : public testing::TestWithParam<Shipped> {};

TEST_P(ShippedRobot, LoadsAndIsTheOneOfTheTests) {
  const std::filesystem::path path = std::filesystem::path(PROWL_SOURCE_DIR) / "robots" / GetParam().file;
  const RobotModel robot = load_robot(read_text_file(path), PackageSearch{{PROWL_ROBOTS_DATA}, {}});
  const RobotModel expected(GetParam().expected());
  EXPECT_EQ(robot.name(), expected.name());
  EXPECT_TRUE(std::filesystem::equivalent(robot.description().urdf, expected.description().urdf));
  ASSERT_EQ(robot.contacts().size(), expected.contacts().size());
  for (std::size_t c = 0; c < robot.contacts().size(); ++c) {
    EXPECT_EQ(robot.contacts()[c].name, expected.contacts()[c].name);
    EXPECT_EQ(robot.contacts()[c].frame, expected.contacts()[c].frame);
    EXPECT_EQ(robot.contacts()[c].radius, expected.contacts()[c].radius);
    EXPECT_EQ(robot.contacts()[c].offset, expected.contacts()[c].offset);
  }
  EXPECT_EQ(robot.nominal_configuration(), expected.nominal_configuration());
  EXPECT_EQ(robot.position_lower(), expected.position_lower());
  EXPECT_EQ(robot.position_upper(), expected.position_upper());
  EXPECT_EQ(robot.velocity_limit(), expected.velocity_limit());
  EXPECT_EQ(robot.torque_limit(), expected.torque_limit());
}

// HyQ's knee cylinder in Semini et al. 2011, "Design of HyQ": 16 mm bore, 80 mm stroke, 16 MPa, a knee of 120 degrees
// and 145 N m.
constexpr double kForce = 16e6 * std::numbers::pi / 4.0 * 0.016 * 0.016;  // [N]
constexpr double kStroke = 0.080;                                         // [m]
constexpr double kRange = 120.0 * std::numbers::pi / 180.0;               // [rad]
constexpr double kLargestTorque = 145.0;                                  // [N m]

/// Distance between the ends of the cylinder at knee position q, in the plane of the leg: the knee is the origin, the
/// hip lies on the x axis. The shank turns by |q| away from the straight leg. Places of both ends by HyQ's own control
/// software.
double cylinder_length(double q) {
  const auto point = [](double distance, double angle) {
    return Eigen::Vector2d(distance * std::cos(angle), distance * std::sin(angle));
  };
  const Eigen::Vector2d on_thigh = point(0.3218, 0.1403);
  const Eigen::Vector2d on_shank = point(0.045, std::numbers::pi - std::abs(q) - 0.1047);
  return (on_thigh - on_shank).norm();
}

/// Torque of the pushing cylinder on the knee, positive towards larger q: virtual work, τ = F ∂c/∂q.
double pushing_torque(double q) {
  constexpr double step = 1e-5;
  return kForce * (cylinder_length(q + step) - cylinder_length(q - step)) / (2.0 * step);
}

/// Distance of a foot from the axis of its hip joint: a turning hip moves the foot by so much.
double leg_length(const RobotModel& robot, const std::string& leg, double knee) {
  RigidBodyTerms terms(robot);
  Eigen::VectorXd q = robot.nominal_configuration();
  const auto joint = [&](const std::string& name) -> double& {
    const auto found = std::ranges::find(robot.joint_names(), leg + name);
    return q(7 + (found - robot.joint_names().begin()));
  };
  joint("_kfe_joint") = knee;
  const auto foot = [&](double turn) {
    joint("_hfe_joint") += turn;
    terms.update_kinematics(q);
    joint("_hfe_joint") -= turn;
    return terms.contact_position(robot.contact_index(leg + "_foot"));
  };
  constexpr double step = 1e-5;
  return (foot(step) - foot(-step)).norm() / (2.0 * step);
}

class ShippedHyq : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Files, ShippedHyq, testing::Values("hyq", "hyq_knees"));

TEST_P(ShippedHyq, KneesAreAsStrongAsTheCylinderThatStretchesTheLeg) {
  const std::string file = std::string(PROWL_SOURCE_DIR) + "/robots/" + GetParam() + ".toml";
  const RobotModel robot = load_robot(read_text_file(file), PackageSearch{{PROWL_ROBOTS_DATA}, {}});
  ASSERT_EQ(robot.torque_curves().size(), 4u);
  for (const RobotModel::TorqueCurve& limit : robot.torque_curves()) {
    const int j = limit.joint;
    const std::string& name = robot.joint_names()[j];
    ASSERT_TRUE(name.ends_with("_kfe_joint")) << name;
    const double lower = robot.position_lower()(j), upper = robot.position_upper()(j);
    EXPECT_NEAR(upper - lower, kRange, 2e-3) << name;

    constexpr int kSteps = 200;
    double largest = 0.0, work = 0.0;  // of the limit, over the range
    for (int i = 0; i <= kSteps; ++i) {
      const double q = lower + (upper - lower) * i / kSteps, push = pushing_torque(q);
      const double strongest = push > 0.0 ? robot.torque_upper(j, q, 0.0) : robot.torque_lower(j, q, 0.0);
      EXPECT_NEAR(strongest, push, 0.1) << name << " at " << q;
      EXPECT_EQ(robot.torque_lower(j, q, 0.0), -robot.torque_upper(j, q, 0.0)) << name << " at " << q;
      const std::string leg = name.substr(0, 2);
      EXPECT_GT(leg_length(robot, leg, q + std::copysign(1e-3, push)), leg_length(robot, leg, q))
          << name << " at " << q;
      largest = std::max(largest, std::abs(strongest));
      work += std::abs(strongest) * (upper - lower) / kSteps * (i == 0 || i == kSteps ? 0.5 : 1.0);
    }
    EXPECT_NEAR(largest, kLargestTorque, 0.5) << name;
    EXPECT_LT(work, kForce * kStroke) << name << ": the cylinder is too short for its work";
    EXPECT_GT(work, 0.95 * kForce * kStroke) << name << ": HyQ's knee takes nearly all of the stroke";
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ShippedRobot,
                         testing::Values(Shipped{"hyq.toml", test::hyq_description},
                                         Shipped{"anymal_c.toml", test::anymal_c_description},
                                         Shipped{"solo12.toml", test::solo12_description},
                                         Shipped{"go2.toml", test::go2_description},
                                         Shipped{"talos.toml", test::talos_description}),
                         [](const auto& info) {
                           const std::string file = info.param.file;
                           return file.substr(0, file.find('.'));
                         });

}  // namespace
}  // namespace prowl
