#include "prowl/task_file/toml/file_keys.hpp"

#include <algorithm>
#include <cassert>

namespace prowl {
namespace {

const char* const kBounds3 = "3 x (number, \"free\" or [min, max])";
const char* const kJointBounds = "{joint = number or [min, max]}";

/// The weights that running and terminal cost share, under the given table.
void add_state_weights(FileKeys& keys, const std::string& table) {
  const char* const vector = "number or 3 numbers >= 0; default 0";
  const char* const joints = "number >= 0, or {joint = number >= 0}; default 0";
  keys.push_back({table, "reference", "\"start\" or \"goal\"; default \"start\"",
                  "configuration that the position weights pull to: that of the start or of the last goal"});
  keys.push_back({table, "base_position", vector, "weight on the displacement of the base, world x y z [1/m²]"});
  keys.push_back(
      {table, "base_orientation", vector, "weight on the rotation vector of the base, x y z of the base [1/rad²]"});
  keys.push_back({table, "joint_position", joints, "weight on joint positions [1/rad²]"});
  keys.push_back(
      {table, "base_linear_velocity", vector, "weight on the linear velocity of the base, base frame [s²/m²]"});
  keys.push_back(
      {table, "base_angular_velocity", vector, "weight on the angular velocity of the base, base frame [s²/rad²]"});
  keys.push_back({table, "joint_velocity", joints, "weight on joint velocities [s²/rad²]"});
  keys.push_back({table, "contact_position", "[[" + table + ".contact_position]]", "weights on positions of contacts"});
  const std::string place = table + ".contact_position";
  keys.push_back({place, "contact", "string", "name of the contact"});
  keys.push_back({place, "reference_m", "3 numbers [m]", "position that the weight pulls to, world frame"});
  keys.push_back(
      {place, "weight", "number or 3 numbers >= 0", "weight on the distance to reference_m, world x y z [1/m²]"});
}

void add_running_weights(FileKeys& keys) {
  const char* const vector = "number or 3 numbers >= 0; default 0";
  const char* const joints = "number >= 0, or {joint = number >= 0}; default 0";
  keys.push_back({"cost", "base_linear_acceleration", vector,
                  "weight on the linear acceleration of the base, base frame [s⁴/m²]"});
  keys.push_back({"cost", "base_angular_acceleration", vector,
                  "weight on the angular acceleration of the base, base frame [s⁴/rad²]"});
  keys.push_back({"cost", "joint_acceleration", joints, "weight on joint accelerations [s⁴/rad²]"});
  keys.push_back({"cost", "torque", joints, "weight on the difference of torques to torque_reference [1/(N m)²]"});
  keys.push_back(
      {"cost", "torque_reference", "\"static\" or \"zero\"; default \"static\"",
       "torques without cost: those that hold the start posture on the contacts of the first phase, or zero"});
  keys.push_back({"cost", "time", "number >= 0; default 0", "cost per second, for phases of free duration [1/s]"});
  keys.push_back({"cost", "force", vector, "weight on the force of every contact, world x y z [1/N²]"});
}

/// Deviations that cost 1 a second each.
void add_tracking(FileKeys& keys) {
  const auto add = [&keys](const char* name, const char* value, const char* meaning) {
    keys.push_back({"tracking", name, value, meaning});
  };
  const char* const weigh = "deviation that costs 1 per second; a smaller value makes the robot stiffer";
  add("step_s", "number, 1e-4 to 0.1 [s]; default 0.002", "time between two gains");
  add("base_position_m", "number or 3 numbers > 0 [m]; default 0.02", weigh);
  add("base_orientation_rad", "number or 3 numbers > 0 [rad]; default 0.04",
      "deviation that costs 1 per second, about the axes of the base");
  add("joint_position_rad", "number > 0, or {joint = number > 0} [rad]; default 0.1", weigh);
  add("base_linear_velocity_mps", "number or 3 numbers > 0 [m/s]; default 0.2",
      "deviation that costs 1 per second, base frame");
  add("base_angular_velocity_radps", "number or 3 numbers > 0 [rad/s]; default 0.4",
      "deviation that costs 1 per second, base frame");
  add("joint_velocity_radps", "number > 0, or {joint = number > 0} [rad/s]; default 10", weigh);
  add("torque_share", "number > 0 [-]; default 0.1",
      "torque that costs 1 per second, as a share of the limit; without a limit, of the weight of the robot times the "
      "reach of "
      "its legs");
  add("landing_s", "number >= 0 [s]; default 1",
      "a landing beside the foothold costs as much as that deviation during this time");
  add("bandwidth_radps", "number > 0 [rad/s]; default 100", "faster gains are reduced to this");
}

FileKeys make_task_file_keys() {
  FileKeys keys = {
      {"", "name", "string; default: the file's name", "name of the motion"},
      {"", "robot", "path", "robot file, relative to this file"},
      {"", "surface", "[[surface]]; default: a floor at z = 0", "planes and patches that contacts may touch"},
      {"", "start", "[start]; default: the robot's nominal posture", "where the motion begins, at rest"},
      {"", "phase", "[[phase]], one or more, or [gait]", "periods with one set of contacts, in order"},
      {"", "gait", "[gait], in place of [[phase]]", "short form of the phases of a robot with four legs"},
      {"", "goal", "[[goal]]", "conditions that hold exactly at some times"},
      {"", "cost", "[cost]", "running cost: half the sum of weight x difference², integrated over time"},
      {"", "terminal_cost", "[terminal_cost]", "the same at the last node, not integrated"},
      {"", "friction_model", "\"cone\" or \"pyramid\"; default \"cone\"",
       "second-order cone, or four planes inside it with up to 29 % less friction"},
      {"", "swing_clearance_m", "number >= 0 [m]; default 5 % of the standing height",
       "height of contacts above the surfaces that they pass, in the middle of the swing"},
      {"", "solver", "[solver]", "when the solver stops"},
      {"", "tracking", "[tracking]", "weights of the feedback gains"},
      {"", "simulation", "[simulation]", "conditions for success in `prowl simulate`"},
      {"surface", "name", "string", "name for phases"},
      {"surface", "point_m", "3 numbers [m]; default [0, 0, 0]", "any point of the plane, world frame"},
      {"surface", "normal", "3 numbers; default [0, 0, 1]", "points out of the ground; any length but zero"},
      {"surface", "patch_m", "3 or more [number, number]; default: a plane without an edge",
       "corners of a convex patch, counterclockwise seen from outside, in surface coordinates: lengths from point_m "
       "along x turned into the plane, and across"},
      {"surface", "friction", "number > 0 [-]; default 0.5", "Coulomb coefficient"},
      {"start", "joints", "{joint = number} [rad]", "joint positions that replace the nominal ones"},
      {"start", "on", "string; default: level ground, z = 0",
       "surface that carries the start posture: above its point_m, turned with it, contacts on its plane"},
      {"start", "base_position_m", "3 numbers [m]; default: over the origin, lowest contact on z = 0",
       "position of the base, world frame"},
      {"start", "base_rpy_rad", "3 numbers [rad]; default: the robot's nominal ones",
       "orientation of the base, R = Rz(yaw) Ry(pitch) Rx(roll); with on, before the turn with the surface"},
      {"phase", "name", "string; default \"phase 1\", \"phase 2\", ...", "name for goals and messages"},
      {"phase", "contacts", "\"all\", or a list of contacts or {contact, surface, place_m}",
       "contacts that hold, on the first surface unless another is given"},
      {"phase", "duration_s", "number from 0.001 to 600, or [min, max] [s]",
       "duration; the optimiser chooses between two bounds"},
      {"phase", "intervals", "integer, 1 to 10000", "number of mesh intervals"},
      {"phase", "steps", "\"equal\" or \"free\"; default \"equal\"",
       "lengths of the intervals; if free, the optimiser chooses each within the bounds of the duration / intervals"},
      {"phase.contacts", "contact", "string", "name of a contact of the robot"},
      {"phase.contacts", "surface", "string", "name of the surface that the contact touches"},
      {"phase.contacts", "place_m", "3 numbers [m]; default: free on the surface",
       "foothold of a contact that lands in this phase, world frame; on the surface"},
      {"gait", "kind", "\"walk\", \"trot\", \"pace\" or \"bound\"", "which feet swing together, and in which order"},
      {"gait", "strides", "integer, 1 to 1000", "number of strides; every foot swings once in each"},
      {"gait", "stride_s", "number from 0.001 to 600, or [min, max] [s]",
       "duration of a stride; between two bounds the optimiser chooses for each phase, which gets its share of both"},
      {"gait", "stride_length_m", "number >= 0 [m]; not with [[goal]]",
       "distance that the base moves along the surface in each stride"},
      {"gait", "heading_rad", "number [rad]; default: where the base faces at the start",
       "direction seen from above, about the world's z from its x"},
      {"gait", "duty_factor", "number, 0.75 (walk) or 0.5 to 0.99; default 0.8 (walk) or 0.6",
       "part of a stride in which a foot is in contact"},
      {"gait", "start_s", "number from 0.001 to 600 [s]; default 0.5",
       "time with all feet in contact before the first stride"},
      {"gait", "settle_s", "number from 0.001 to 600 [s]; default 0.5",
       "time with all feet in contact after the last landing"},
      {"gait", "surface", "string; default: the first surface", "name of the surface that the feet touch"},
      {"gait", "intervals_per_second", "number > 0 [1/s]; default 50",
       "mesh of every phase; at least 2 intervals each"},
      {"goal", "time_s", "number > 0 [s], at a node", "time of the goal; either this or phase"},
      {"goal", "phase", "string", "the goal holds at the end of the phase with this name"},
      {"goal", "fraction", "number, 0 to 1, at a node; default 1",
       "part of the phase at which the goal holds, instead of its end"},
      {"goal", "base_position_m", kBounds3, "position of the base, world frame [m]"},
      {"goal", "base_displacement_m", kBounds3, "displacement of the base from the start, world axes [m]"},
      {"goal", "base_rpy_rad", "3 x (number or \"free\")",
       "orientation of the base, as in [start]; if free, it may turn about that axis of the base in its goal "
       "orientation [rad]"},
      {"goal", "base_linear_velocity_mps", kBounds3, "velocity of the base, base frame [m/s]"},
      {"goal", "base_angular_velocity_radps", kBounds3, "angular velocity of the base, base frame [rad/s]"},
      {"goal", "joints", kJointBounds, "joint positions [rad]"},
      {"goal", "joint_velocity_radps", kJointBounds, "joint velocities [rad/s]"},
      {"goal", "torque_Nm", kJointBounds, "joint torques [N m]"},
  };
  add_state_weights(keys, "cost");
  add_running_weights(keys);
  add_state_weights(keys, "terminal_cost");
  add_tracking(keys);
  keys.push_back(
      {"solver", "tolerance", "number, 1e-12 to 1e-2; default 1e-6", "on optimality and on the constraints"});
  keys.push_back(
      {"solver", "max_iterations", "integer >= 1; default 300", "stop after this many iterations, on each mesh"});
  keys.push_back({"solver", "max_time_s", "number > 0 [s]; default 300", "stop after this much wall-clock time"});
  keys.push_back({"simulation", "base_position_m", "number > 0 [m]; default 0.02",
                  "largest distance of the base at rest from the end of the plan"});
  keys.push_back({"simulation", "base_angle_rad", "number > 0 [rad]; default 0.035",
                  "largest angle of the base at rest from the end of the plan"});
  keys.push_back({"simulation", "slip_m", "number > 0 [m]; default 0.02", "largest slip of a foot in contact"});
  keys.push_back({"simulation", "friction", "number > 0; default: that of each [[surface]]",
                  "friction coefficient of all surfaces; a larger one than in the plan gives a margin"});
  keys.push_back({"simulation", "rest_s", "number > 0 [s]; default 1.5", "time that the robot stands after the plan"});
  return keys;
}

}  // namespace

const FileKeys& robot_file_keys() {
  static const FileKeys keys = {
      {"", "name", "string", "name of the robot"},
      {"", "urdf", "path or package://...", "URDF of the robot; a path is relative to this file"},
      {"", "package_dirs", "list of paths; default none",
       "folders to search first for package://, relative to this file"},
      {"", "contact", "[[contact]], one or more", "points of the robot that may touch surfaces"},
      {"", "nominal", "[nominal]", "default posture at the start of a motion"},
      {"", "limits", "[limits.JOINT]", "limits that replace those of the URDF"},
      {"contact", "name", "string", "name of the contact, unique in the robot"},
      {"contact", "frame", "string", "link or fixed joint of the URDF that carries the contact"},
      {"contact", "radius_m", "number >= 0 [m]; default 0", "radius of the ball around the point"},
      {"contact", "offset_m", "3 numbers [m]; default [0, 0, 0]", "centre of the ball, in the frame"},
      {"nominal", "base_rpy_rad", "3 numbers [rad]; default [0, 0, 0]",
       "orientation of the base, R = Rz(yaw) Ry(pitch) Rx(roll); its position follows from the contacts"},
      {"nominal", "joints", "{joint = number} [rad]; default 0", "joint positions"},
      {"limits", "position_rad", "[min, max] [rad]", "range of the joint position"},
      {"limits", "velocity_radps", "number > 0 [rad/s]", "largest joint velocity, in both directions"},
      {"limits", "torque_Nm", "number > 0 [N m]", "largest joint torque, in both directions"},
      {"limits", "torque_over_position", "4 or more points [rad, N m]; default none",
       "torque limit over the joint position, in both directions: a smooth curve through these points, which cover the "
       "range"},
      {"limits", "torque_over_velocity", "4 or more points [rad/s, N m]; default none",
       "torque limit in the direction of positive velocity, over -velocity ... velocity; mirrored for the other "
       "direction"},
  };
  return keys;
}

const FileKeys& task_file_keys() {
  static const FileKeys keys = make_task_file_keys();
  return keys;
}

std::vector<std::string> key_names(const FileKeys& keys, const std::string& table) {
  std::vector<std::string> names;
  for (const FileKey& key : keys) {
    if (key.table == table) names.push_back(key.name);
  }
  return names;
}

const std::string& key_meaning(const FileKeys& keys, const std::string& table, const std::string& name) {
  const auto key =
      std::find_if(keys.begin(), keys.end(), [&](const FileKey& k) { return k.table == table && k.name == name; });
  assert(key != keys.end());
  return key->meaning;
}

}  // namespace prowl
