#include <gtest/gtest.h>

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
