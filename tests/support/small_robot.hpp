#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "prowl/model/robot_description.hpp"

/// A base with two one-joint legs, as the text of a URDF that tests then damage in one place.
namespace prowl::test {

inline const char* small_urdf() {
  return R"(<?xml version="1.0"?>
<robot name="small">
  <link name="base">
    <inertial>
      <origin xyz="0 0 0.1" rpy="0 0 0"/>
      <mass value="10"/>
      <inertia ixx="0.2" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.4"/>
    </inertial>
  </link>
  <link name="left_leg">
    <inertial>
      <origin xyz="0 0 -0.25"/>
      <mass value="1"/>
      <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.001"/>
    </inertial>
  </link>
  <link name="right_leg">
    <inertial>
      <origin xyz="0 0 -0.25"/>
      <mass value="1"/>
      <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.001"/>
    </inertial>
  </link>
  <link name="left_foot"/>
  <link name="right_foot"/>
  <joint name="left_hip" type="revolute">
    <parent link="base"/>
    <child link="left_leg"/>
    <origin xyz="0 0.1 0" rpy="0 0 0"/>
    <axis xyz="1 0 0"/>
    <limit lower="-0.5" upper="1.5" velocity="10" effort="50"/>
  </joint>
  <joint name="right_hip" type="revolute">
    <parent link="base"/>
    <child link="right_leg"/>
    <origin xyz="0 -0.1 0" rpy="0 0 0"/>
    <axis xyz="1 0 0"/>
    <limit lower="-1.5" upper="0.5" velocity="10" effort="50"/>
  </joint>
  <joint name="left_ankle" type="fixed">
    <parent link="left_leg"/>
    <child link="left_foot"/>
    <origin xyz="0 0 -0.5"/>
  </joint>
  <joint name="right_ankle" type="fixed">
    <parent link="right_leg"/>
    <child link="right_foot"/>
    <origin xyz="0 0 -0.5"/>
  </joint>
</robot>
)";
}

/// A chain of `joints` moving links.
inline std::string chain_urdf(int joints) {
  const std::string inertial =
      "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
      "izz=\"1\"/></inertial></link>";
  std::string xml = "<robot name=\"chain\"><link name=\"l0\">" + inertial;
  for (int i = 1; i <= joints; ++i) {
    const std::string child = std::to_string(i);
    const std::string parent = std::to_string(i - 1);
    xml += "<link name=\"l" + child + "\">" + inertial + "<joint name=\"j" + child +
           "\" type=\"revolute\"><parent link=\"l" + parent + "\"/><child link=\"l" + child +
           "\"/><origin xyz=\"0 0 0.1\"/>" + "<limit lower=\"-1\" upper=\"1\" velocity=\"1\" effort=\"1\"/></joint>";
  }
  return xml + "</robot>";
}

/// `text` with the first `from` replaced by `to`; it must be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "nothing to replace: " << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A folder of its own for each test, gone at its end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) / (std::string(info->test_suite_name()) + "." + info->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// The small robot with both feet as contacts; `urdf` is a file.
inline RobotDescription small_description(const std::filesystem::path& urdf) {
  RobotDescription robot;
  robot.name = "small";
  robot.urdf = urdf;
  robot.contacts = {{"left_foot", "left_foot", 0.02}, {"right_foot", "right_foot", 0.02}};
  return robot;
}

}  // namespace prowl::test
