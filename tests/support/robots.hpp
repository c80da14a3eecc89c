#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

/// The five test robots, from the URDFs of example-robot-data, in the postures and with the contacts and limits of
/// robots/*.toml (not HyQ's torque curves), but without reading a robot file: layers below prowl/task_file are tested
/// without it.
namespace prowl::test {

inline std::filesystem::path robots_data() {
  return std::filesystem::path(PROWL_ROBOTS_DATA) / "example-robot-data" / "robots";
}

/// Knees bend one way, front knees to negative angles [rad].
inline JointLimits knee(double front, double most) {
  return front > 0.0 ? JointLimits{-most, -0.1, {}, {}} : JointLimits{0.1, most, {}, {}};
}

inline RobotDescription hyq_description() {
  RobotDescription robot;
  robot.name = "HyQ";
  robot.urdf = robots_data() / "hyq_description/robots/hyq_no_sensors.urdf";
  for (const char* leg : {"lf", "lh", "rf", "rh"}) {
    const std::string name = leg;
    const double front = name[1] == 'f' ? 1.0 : -1.0;
    robot.contacts.push_back({name + "_foot", name + "_foot", 0.02175});
    robot.nominal_joints[name + "_haa_joint"] = -0.2;
    robot.nominal_joints[name + "_hfe_joint"] = front * 0.75;
    robot.nominal_joints[name + "_kfe_joint"] = front * -1.5;
  }
  return robot;
}

inline RobotDescription anymal_c_description() {
  RobotDescription robot;
  robot.name = "ANYmal C";
  robot.urdf = robots_data() / "anymal_c_simple_description/urdf/anymal.urdf";
  for (const char* leg : {"LF", "LH", "RF", "RH"}) {
    const std::string name = leg;
    const double left = name[0] == 'L' ? 1.0 : -1.0, front = name[1] == 'F' ? 1.0 : -1.0;
    robot.contacts.push_back({name + "_FOOT", name + "_FOOT", 0.03, {0.0, 0.0, 0.0225}});
    robot.nominal_joints[name + "_HAA"] = left * -0.1;
    robot.nominal_joints[name + "_HFE"] = front * 0.7;
    robot.nominal_joints[name + "_KFE"] = -front;
    robot.limits[name + "_HFE"] = {-2.0, 2.0, {}, {}};
    robot.limits[name + "_KFE"] = knee(front, 2.6);
  }
  return robot;
}

inline RobotDescription solo12_description() {
  RobotDescription robot;
  robot.name = "Solo12";
  robot.urdf = robots_data() / "solo_description/robots/solo12.urdf";
  for (const char* leg : {"FL", "FR", "HL", "HR"}) {
    const std::string name = leg;
    const double front = name[0] == 'F' ? 1.0 : -1.0, left = name[1] == 'L' ? 1.0 : -1.0;
    robot.contacts.push_back({name + "_FOOT", name + "_FOOT", 0.016});
    robot.nominal_joints[name + "_HAA"] = left * 0.1;
    robot.nominal_joints[name + "_HFE"] = front * 0.8;
    robot.nominal_joints[name + "_KFE"] = front * -1.6;
    robot.limits[name + "_HAA"] = {-1.0, 1.0, 30.0, 2.7};
    robot.limits[name + "_HFE"] = {-2.0, 2.0, 30.0, 2.7};
    robot.limits[name + "_KFE"] = knee(front, 2.8);
    robot.limits[name + "_KFE"].velocity = 30.0;
    robot.limits[name + "_KFE"].torque = 2.7;
  }
  return robot;
}

inline RobotDescription go2_description() {
  RobotDescription robot;
  robot.name = "Go2";
  robot.urdf = robots_data() / "go2_description/urdf/go2.urdf";
  for (const char* leg : {"FL", "FR", "RL", "RR"}) {
    const std::string name = leg;
    robot.contacts.push_back({name + "_foot", name + "_foot", 0.022});
    robot.nominal_joints[name + "_hip_joint"] = name[1] == 'L' ? 0.068 : -0.068;
    robot.nominal_joints[name + "_thigh_joint"] = 0.785;
    robot.nominal_joints[name + "_calf_joint"] = -1.44;
  }
  return robot;
}

/// Two flat feet of four corner points each: 24 contact rows of rank 12.
inline RobotDescription talos_description() {
  RobotDescription robot;
  robot.name = "Talos";
  robot.urdf = robots_data() / "talos_data/robots/talos_reduced.urdf";
  for (const char* side : {"left", "right"}) {
    const std::string name = side;
    const double left = name == "left" ? 1.0 : -1.0;
    for (const double x : {0.095, -0.105}) {
      for (const double y : {0.061, -0.061}) {
        const std::string corner = std::string(x > 0.0 ? "_front" : "_rear") + (y > 0.0 ? "_left" : "_right");
        robot.contacts.push_back({name + corner, name + "_sole_link", 0.0, {x, y, 0.0}});
      }
    }
    const std::map<std::string, double> joints = {
        {"leg_" + name + "_3_joint", -0.411354},
        {"leg_" + name + "_4_joint", 0.859395},
        {"leg_" + name + "_5_joint", -0.448041},
        {"leg_" + name + "_6_joint", -0.001708},
        {"arm_" + name + "_1_joint", left * 0.25847},
        {"arm_" + name + "_2_joint", left * 0.173046},
        {"arm_" + name + "_3_joint", left * -0.0002},
        {"arm_" + name + "_4_joint", -0.525366},
        {"arm_" + name + "_7_joint", 0.1},
    };
    robot.nominal_joints.insert(joints.begin(), joints.end());
  }
  robot.nominal_joints["torso_2_joint"] = 0.006761;
  return robot;
}

inline RobotModel hyq() { return RobotModel(hyq_description()); }
inline RobotModel anymal_c() { return RobotModel(anymal_c_description()); }
inline RobotModel solo12() { return RobotModel(solo12_description()); }
inline RobotModel go2() { return RobotModel(go2_description()); }
inline RobotModel talos() { return RobotModel(talos_description()); }

}  // namespace prowl::test
