#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prowl/io/robot_file.hpp"
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

/// The geometry that robots/hyq.toml tells, computed here by way of the angle at the cylinder's far end.
TEST(ShippedHyq, KneesHaveTheTorqueOfACylinderOnALever) {
  constexpr double a = 0.3218, b = 0.045, force = 16e6 * 2.0106e-4;
  const auto torque = [&](double angle) {
    const Eigen::Vector2d knee(0.0, 0.0), far(a, 0.0);
    const double turned = M_PI - angle - 0.1403 - 0.1047;
    const Eigen::Vector2d near(b * std::cos(turned), b * std::sin(turned)), along = (near - far).normalized();
    return force * std::abs((knee - far).x() * along.y() - (knee - far).y() * along.x());
  };
  const RobotModel robot = load_robot(read_text_file(std::filesystem::path(PROWL_SOURCE_DIR) / "robots/hyq.toml"),
                                      PackageSearch{{PROWL_ROBOTS_DATA}, {}});
  ASSERT_EQ(robot.torque_curves().size(), 4u);
  for (const RobotModel::TorqueCurve& limit : robot.torque_curves()) {
    EXPECT_TRUE(robot.joint_names()[limit.joint].ends_with("_kfe_joint"));
    const double lower = robot.position_lower()(limit.joint), upper = robot.position_upper()(limit.joint);
    double largest = 0.0;
    for (int i = 0; i <= 100; ++i) {
      const double q = lower + (upper - lower) * i / 100;
      EXPECT_NEAR(limit.curve.value(q), torque(std::abs(q)), 0.1) << q;
      largest = std::max(largest, limit.curve.value(q));
    }
    EXPECT_NEAR(largest, 145.0, 0.5);
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
