#include "prowl/task_file/robot_file.hpp"

#include <gmock/gmock.h>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using test::kHyqFile;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class RobotFile : public testing::Test {
 protected:
  std::string message_of(const std::string& text) {
    return test::message_of(folder_.path(),
                            [&] { load_robot(read_text_file(folder_.write("hyq.toml", text)), test::test_search()); });
  }
  std::string message(const std::string& from, const std::string& to) {
    return message_of(test::replaced(kHyqFile, from, to));
  }

  test::TempFolder folder_;
};

TEST_F(RobotFile, GivesTheRobotThatItDescribes) {
  const std::string limits = "[limits.lf_haa_joint]\nposition_rad = [-0.5, 0.25]\ntorque_Nm = 80\n";
  const std::string with_offset =
      test::replaced(kHyqFile, "\"rf_foot\", radius", "\"rf_foot\", offset_m = [1, 2, 3], radius");
  const RobotModel robot = load_robot({"hyq.toml", with_offset + limits}, test::test_search());
  EXPECT_EQ(robot.name(), "HyQ");
  EXPECT_EQ(robot.nu(), 12);
  ASSERT_EQ(robot.contacts().size(), 4u);
  EXPECT_EQ(robot.contacts()[0].frame, "lf_foot");
  EXPECT_EQ(robot.contacts()[0].radius, 0.02175);
  EXPECT_EQ(robot.contacts()[1].offset, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(robot.position_lower()(0), -0.5);
  EXPECT_EQ(robot.position_upper()(0), 0.25);
  EXPECT_EQ(robot.torque_limit()(0), 80.0);
  EXPECT_EQ(robot.velocity_limit()(0), 12.0) << "HyQ's URDF, as the file does not replace it";
  EXPECT_EQ(robot.nominal_configuration()(9), -1.5);
}

TEST_F(RobotFile, NamesTheNearestFrame) {
  const std::string message = this->message("frame = \"rf_foot\"", "frame = \"rf_fot\"");
  EXPECT_THAT(message, StartsWith("hyq.toml:5:"));
  EXPECT_THAT(message, HasSubstr("contact[1].frame: "));
  EXPECT_THAT(message, HasSubstr("'rf_fot'"));
  EXPECT_THAT(message, EndsWith("did you mean 'rf_foot'?"));
}

TEST_F(RobotFile, NamesTheNearestJoint) {
  const std::string nominal = message("lh_kfe_joint", "lh_kef_joint");
  EXPECT_THAT(nominal, StartsWith("hyq.toml:18:1: nominal.joints.lh_kef_joint: "));
  EXPECT_THAT(nominal, EndsWith("did you mean 'lh_kfe_joint'?"));
  const std::string limits = message_of(kHyqFile + "[limits.lf_haa]\ntorque_Nm = 10\n");
  EXPECT_THAT(limits, StartsWith("hyq.toml:22:9: limits.lf_haa: "));
}

/// Where the fault is, not where something was mended.
TEST_F(RobotFile, NamesTheUrdfForWhatItDoesNotReplace) {
  const std::string mended =
      kHyqFile + "[limits.lf_haa_joint]\nvelocity_radps = 5\n[limits.lf_kfe_joint]\nposition_rad = [-1, -1]\n";
  EXPECT_THAT(message_of(mended), StartsWith("hyq.toml:24:9: limits.lf_kfe_joint: "));
}

TEST_F(RobotFile, RefusesUnknownKeysWithTheNearest) {
  EXPECT_EQ(message("frame = \"lf_foot\", radius_m", "frame = \"lf_foot\", radius_mm"),
            "hyq.toml:4:42: contact[0].radius_mm: unknown key; did you mean 'radius_m'? "
            "Known: name, frame, radius_m, offset_m");
  EXPECT_THAT(message_of(kHyqFile + "[limits.lf_haa_joint]\ntorque_nm = 10\n"),
              StartsWith("hyq.toml:23:1: limits.lf_haa_joint.torque_nm: unknown key; did you mean 'torque_Nm'?"));
}

TEST_F(RobotFile, RefusesWrongValues) {
  EXPECT_THAT(message("frame = \"lf_foot\", radius_m = 0.02175", "frame = \"lf_foot\", radius_m = -0.02"),
              EndsWith("contact[0].radius_m: -0.02 is not allowed; need a finite number >= 0 [m]"));
  EXPECT_THAT(message("{ name = \"rf_foot\"", "{ name = \"lf_foot\""),
              EndsWith("contact[1].name: \"lf_foot\" is already another contact"));
  EXPECT_EQ(message_of(kHyqFile + "[limits.lf_haa_joint]\nposition_rad = [1, -1]\n"),
            "hyq.toml:23:16: limits.lf_haa_joint.position_rad: min > max is not allowed; need [min, max]");
  EXPECT_THAT(message_of(kHyqFile + "[limits.lf_haa_joint]\ntorque_Nm = 0\n"),
              EndsWith("torque_Nm: 0 is not allowed; need a finite number > 0 [N m]"));
}

TEST_F(RobotFile, RefusesNamesThatBreakFiles) {
  for (const char* name : {"lf,foot", "lf\\nfoot", "lf foot ", "f\u00fc\u00df"}) {
    EXPECT_THAT(
        message("{ name = \"lf_foot\"", std::string("{ name = \"") + name + "\""),
        StartsWith("hyq.toml:4:12: contact[0].name: this name is not allowed; need at most 200 printable ASCII"))
        << name;
  }
}

TEST_F(RobotFile, RefusesNumbersBeyondAllSense) {
  EXPECT_EQ(
      message_of(kHyqFile + "[limits.lf_haa_joint]\ntorque_Nm = 1e200\n"),
      "hyq.toml:23:13: limits.lf_haa_joint.torque_Nm: 1e+200 is not allowed; need a number of at most 1e+09 in size");
}

TEST_F(RobotFile, TellsOtherKindsOfFiles) {
  EXPECT_EQ(message_of(test::kTaskFile),
            "hyq.toml:3:1: phase: this looks like a task file; need the robot file that it names");
  EXPECT_THAT(message_of("<?xml version=\"1.0\"?>\n<robot name=\"dog\"/>"),
              StartsWith("hyq.toml:1:1: this looks like XML; "));
}

TEST_F(RobotFile, NeedsContactsUnlessAskedNotTo) {
  const std::string text = "name = \"HyQ\"\n" + kHyqFile.substr(kHyqFile.find("urdf = "),
                                                                kHyqFile.find("contact = ") - kHyqFile.find("urdf = "));
  EXPECT_THAT(message_of(text), StartsWith("hyq.toml:1:1: contact: missing; need "));
  EXPECT_EQ(load_robot({"hyq.toml", text}, test::test_search(), {.needs_contacts = false}).nu(), 12);
}

TEST_F(RobotFile, NamesItsLineIfTheUrdfIsEmpty) {
  folder_.write("empty.urdf", "");
  folder_.write("comment.urdf", "<!-- nothing -->");
  for (const char* urdf : {"empty.urdf", "comment.urdf"}) {
    const std::string text =
        std::string("name = \"dog\"\nurdf = \"") + urdf + "\"\n[[contact]]\nname = \"foot\"\nframe = \"foot\"\n";
    EXPECT_THAT(message_of(text), StartsWith(std::string("hyq.toml:2:8: urdf: ") + urdf + ":"));
  }
}

TEST_F(RobotFile, ListsEveryFolderWhereTheUrdfIsNot) {
  const std::string message = this->message("hyq_no_sensors.urdf", "hyq_no_sensor.urdf");
  EXPECT_THAT(message, StartsWith("hyq.toml:2:8: urdf: \"package://example-robot-data/robots/"));
  EXPECT_THAT(message, HasSubstr(std::string("\n  ") + PROWL_ROBOTS_DATA + "/example-robot-data/robots/"));
  EXPECT_THAT(message, HasSubstr("\n  /example-robot-data/robots/")) << "the root is an ancestor, too";
}

TEST_F(RobotFile, FindsThePathsRelativeToItself) {
  const auto source =
      std::filesystem::path(PROWL_ROBOTS_DATA) / "example-robot-data/robots/hyq_description/robots/hyq_no_sensors.urdf";
  folder_.write("models/hyq.urdf", test::read_file(source));
  const std::string text =
      "name = \"HyQ\"\nurdf = \"../models/hyq.urdf\"\n[[contact]]\nname = \"foot\"\nframe = \"lf_foot\"\n";
  const auto file = folder_.write("robots/hyq.toml", text);
  EXPECT_EQ(read_robot_file(file, {}).urdf, folder_.path() / "models/hyq.urdf");
  EXPECT_EQ(load_robot(read_text_file(file), {}).nu(), 12);
}

}  // namespace
}  // namespace prowl
