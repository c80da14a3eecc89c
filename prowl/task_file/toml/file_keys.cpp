#include "prowl/task_file/toml/file_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>

#include "prowl/mesh/mesh.hpp"
#include "prowl/model/robot_description.hpp"
#include "prowl/model/surface.hpp"
#include "prowl/motion/disturbances.hpp"
#include "prowl/motion/duration_limits.hpp"
#include "prowl/motion/gait.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/simulation/simulation_options.hpp"
#include "prowl/tracking/tracking_options.hpp"

namespace prowl {
namespace {

const NumberRange kPositive = NumberRange::positive();
const NumberRange kNonnegative = NumberRange::nonnegative();
/// One turn either way: larger angles are degrees by mistake.
const NumberRange kAngle = {.lower = -6.2832, .upper = 6.2832, .hint = "; 5 degrees are 0.087"};
const NumberRange kDuration = {.lower = kShortestPhase, .upper = kLongestMotion};
/// Lower bound, as weights are 1 / deviation².
const NumberRange kDeviation = {.lower = 1e-6};
/// More strides are a typing mistake, and need gigabytes of memory.
constexpr double kMostStrides = 1000;

const char* const kOneOrThree = "number or 3 numbers";
const char* const kOneOrJoints = "number or {joint = number}";
const char* const kOneOrRange = "number or [min, max]";
const char* const kBounds3 = "3 x (number, \"free\" or [min, max])";
const char* const kOneSidedBounds3 = "3 x (number, \"free\" or [min, max]; min or max may be \"free\")";
const char* const kOneSidedJointBounds = "{joint = number or [min, max]; min or max may be \"free\"}";
const char* const kJointBounds = "{joint = number or [min, max]}";

std::string number_text(double number) { return fmt::format("{:g}", number); }

/// Adds keys to one table.
class Table {
 public:
  Table(FileKeys& keys, std::string name) : keys_(keys), name_(std::move(name)) {}

  void add(FileKey key) {
    key.table = name_;
    keys_.push_back(std::move(key));
  }

 private:
  FileKeys& keys_;
  std::string name_;
};

void add_top(FileKeys& keys) {
  Table top(keys, "");
  top.add({.name = "name", .form = "string", .fallback = "the file's name", .meaning = "name of the motion"});
  top.add({.name = "robot", .form = "path", .meaning = "robot file, relative to this file"});
  top.add({.name = "surface",
           .form = "[[surface]]",
           .fallback = "a floor at z = 0",
           .meaning = "planes and patches that contacts may touch"});
  top.add({.name = "payload",
           .form = "[[payload]]",
           .fallback = "none",
           .meaning = "what the robot carries: part of its mass in plan, gains, certificate and simulation"});
  top.add({.name = "start",
           .form = "[start]",
           .fallback = "the robot's nominal posture",
           .meaning = "where the motion begins"});
  top.add({.name = "phase",
           .form = "[[phase]], one or more, or [gait]",
           .meaning = "periods with one set of contacts, in order"});
  top.add({.name = "gait",
           .form = "[gait], in place of [[phase]]",
           .meaning = "short form of the phases of a robot with four legs"});
  top.add({.name = "goal", .form = "[[goal]]", .meaning = "conditions that hold exactly at some times"});
  top.add({.name = "cost",
           .form = "[cost]",
           .meaning = "running cost: half the sum of weight x difference², integrated over time"});
  top.add({.name = "terminal_cost", .form = "[terminal_cost]", .meaning = "the same at the last node, not integrated"});
  top.add({.name = "term",
           .form = "[[term]]",
           .meaning = "limits and costs of frames, centre of mass, joints, forces, and of one's own"});
  top.add({.name = "reference", .form = "[reference]", .meaning = "motion that the plan follows, as a cost"});
  top.add({.name = "friction_model",
           .choices = {"cone", "pyramid"},
           .fallback = "\"cone\"",
           .meaning = "second-order cone, or four planes inside it with up to 29 % less friction"});
  top.add({.name = "swing_clearance_m",
           .form = "number",
           .range = kNonnegative,
           .unit = "m",
           .fallback = fmt::format("{:g} % of the standing height", 100.0 * kSwingClearanceShare),
           .meaning = "height of contacts above the surfaces that they pass, in the middle of the swing"});
  top.add({.name = "least_load",
           .form = "number",
           .range = {.lower = 0.0, .upper = 0.9},
           .unit = "-",
           .fallback = number_text(kLeastLoadShare),
           .meaning = "normal force that each contact carries at least while it holds, as a share of its even load: "
                      "the weight on that slope / number of contacts"});
  top.add({.name = "solver", .form = "[solver]", .meaning = "stopping criteria of the solver"});
  top.add({.name = "tracking", .form = "[tracking]", .meaning = "weights of the feedback gains"});
  top.add({.name = "robust", .form = "[robust]", .meaning = "makes the plan hold under disturbances of these sizes"});
  top.add({.name = "simulation", .form = "[simulation]", .meaning = "conditions for success in `prowl simulate`"});
}

void add_surface(FileKeys& keys) {
  Table surface(keys, "surface");
  surface.add({.name = "name", .form = "string", .meaning = "name for phases"});
  surface.add({.name = "point_m",
               .form = "3 numbers",
               .unit = "m",
               .fallback = "[0, 0, 0]",
               .meaning = "any point of the plane, world frame"});
  surface.add({.name = "normal",
               .form = "3 numbers",
               .fallback = "[0, 0, 1]",
               .meaning = "points out of the ground; any length but zero"});
  surface.add({.name = "patch_m",
               .form = "3 or more [number, number]",
               .unit = "m",
               .fallback = "a plane without an edge",
               .meaning = "corners of a convex patch, counterclockwise seen from outside, in surface coordinates "
                          "from point_m: along the world's x turned into the plane, and across"});
  surface.add({.name = "friction",
               .form = "number",
               .range = kPositive,
               .unit = "-",
               .fallback = number_text(Surface{}.friction),
               .meaning = "Coulomb coefficient"});
}

void add_payload(FileKeys& keys) {
  Table payload(keys, "payload");
  payload.add({.name = "body", .form = "string", .meaning = "link of the URDF that it moves with"});
  payload.add({.name = "mass_kg", .form = "number", .range = kPositive, .unit = "kg", .meaning = "its mass"});
  payload.add({.name = "com_m",
               .form = "3 numbers",
               .unit = "m",
               .fallback = "[0, 0, 0]",
               .meaning = "its centre of mass in the frame of the link; it has no moment of inertia about that"});
}

void add_start(FileKeys& keys) {
  Table start(keys, "start");
  start.add({.name = "joints",
             .form = kJointBounds,
             .unit = "rad",
             .meaning = "joint positions that replace the nominal ones"});
  start.add(
      {.name = "on",
       .form = "string",
       .fallback = "level ground, z = 0",
       .meaning = "surface that carries the start posture: above its point_m, turned with it, contacts on its plane"});
  start.add({.name = "base_position_m",
             .form = kBounds3,
             .unit = "m",
             .fallback = "over the origin, lowest contact on z = 0",
             .meaning = "position of the base, world frame"});
  start.add({.name = "base_rpy_rad",
             .form = kBounds3,
             .range = kAngle,
             .unit = "rad",
             .fallback = "the robot's nominal ones",
             .meaning =
                 "orientation of the base, R = Rz(yaw) Ry(pitch) Rx(roll); with on, before the turn with the surface"});
  start.add({.name = "base_linear_velocity_mps",
             .form = kBounds3,
             .unit = "m/s",
             .fallback = "0",
             .meaning = "velocity of the base, base frame"});
  start.add({.name = "base_angular_velocity_radps",
             .form = kBounds3,
             .unit = "rad/s",
             .fallback = "0",
             .meaning = "angular velocity of the base, base frame"});
  start.add({.name = "joint_velocity_radps",
             .form = kJointBounds,
             .unit = "rad/s",
             .fallback = "those that keep the contacts of the first phase still",
             .meaning = "joint velocities; corrected where contacts move at up to 0.05 m/s"});
}

void add_phase(FileKeys& keys) {
  Table phase(keys, "phase");
  phase.add({.name = "name",
             .form = "string",
             .fallback = "\"phase 1\", \"phase 2\", ...",
             .meaning = "name for goals and messages"});
  phase.add({.name = "contacts",
             .form = "\"all\", or a list of contacts or {contact, surface, place_m, unloaded}",
             .meaning = "contacts that hold, on the first surface unless another is given"});
  phase.add({.name = "duration_s",
             .form = kOneOrRange,
             .range = kDuration,
             .unit = "s",
             .meaning = "duration; the optimiser chooses between two bounds"});
  phase.add({.name = "intervals",
             .form = "integer",
             .range = {.lower = 1, .upper = kMostIntervals},
             .fallback = "chosen and refined by Prowl, in all phases",
             .meaning = "number of mesh intervals"});
  phase.add({.name = "steps",
             .choices = {"equal", "free"},
             .fallback = "\"equal\"",
             .meaning = "lengths of the intervals; if free, the optimiser chooses each within the bounds of the "
                        "duration / intervals, a key that it needs"});

  Table contacts(keys, "phase.contacts");
  contacts.add({.name = "contact", .form = "string", .meaning = "name of a contact of the robot"});
  contacts.add({.name = "surface", .form = "string", .meaning = "name of the surface that the contact touches"});
  contacts.add({.name = "place_m",
                .form = "3 numbers",
                .unit = "m",
                .fallback = "free on the surface",
                .meaning = "foothold of a contact that lands in this phase, world frame; on the surface"});
  contacts.add({.name = "unloaded",
                .form = "true or false",
                .fallback = "false",
                .meaning = "the contact may carry nothing: `least_load` does not count for it"});
}

std::vector<std::string> gait_names() {
  std::vector<std::string> names;
  for (const GaitPattern& pattern : gait_patterns()) names.push_back(pattern.name);
  return names;
}

/// "0.8 (walk), 0.6 (trot)": one number per pattern.
template <typename Number>
std::string of_each_gait(const Number& number) {
  std::vector<std::string> texts;
  for (const GaitPattern& pattern : gait_patterns()) {
    texts.push_back(fmt::format("{:g} ({})", number(pattern), pattern.name));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

void add_gait(FileKeys& keys) {
  Table gait(keys, "gait");
  gait.add({.name = "kind", .choices = gait_names(), .meaning = "which feet swing together, and in which order"});
  gait.add({.name = "strides",
            .form = "integer",
            .range = {.lower = 1, .upper = kMostStrides},
            .meaning = "number of strides; every foot swings once in each"});
  gait.add({.name = "periodic",
            .form = "true or false",
            .fallback = "false",
            .meaning =
                "true: strides that end as they began, moved by one stride, instead of a motion from rest to rest; "
                "needs a time in which all feet stand"});
  gait.add({.name = "stride_s",
            .form = kOneOrRange,
            .range = kDuration,
            .unit = "s",
            .fallback = "by the height of the robot, shorter for high speeds",
            .meaning = "duration of a stride; between two bounds the optimiser chooses each phase within its share "
                       "of both"});
  gait.add({.name = "speed_mps",
            .form = "number",
            .range = kNonnegative,
            .unit = "m/s",
            .meaning = "mean speed of the base along the surface in a stride; not with [[goal]] or stride_length_m"});
  gait.add({.name = "stride_length_m",
            .form = "number",
            .range = kNonnegative,
            .unit = "m",
            .meaning = "distance that the base moves along the surface in each stride, in place of a speed; not with "
                       "[[goal]]"});
  gait.add({.name = "heading_rad",
            .form = "number",
            .range = kAngle,
            .unit = "rad",
            .fallback = "where the base faces at the start",
            .meaning = "walking direction, angle about the world's z from its x"});
  gait.add({.name = "turn_rad",
            .form = "number",
            .range = kAngle,
            .unit = "rad",
            .fallback = "0",
            .meaning = "turn of the base in each stride, about the surface's normal; its way bends as much"});
  // Both a stance and a swing take time; feet that stand for less carry five times the weight.
  constexpr double kLeastDutyFactor = 0.2, kLargestDutyFactor = 0.99;
  gait.add(
      {.name = "duty_factor",
       .form = "number",
       .range = {.lower = kLeastDutyFactor, .upper = kLargestDutyFactor},
       .unit = "-",
       .fallback = fmt::format("{}; with a speed_mps above 0.1 sqrt(gravity x height) {}",
                               of_each_gait([](const GaitPattern& pattern) { return pattern.slow_duty_factor; }),
                               of_each_gait([](const GaitPattern& pattern) { return pattern.fast_duty_factor; })),
       .meaning = fmt::format("fraction of the stride for which each foot stands; swings overlap below {}",
                              of_each_gait([](const GaitPattern& pattern) { return pattern.least_duty_factor(); }))});
  gait.add({.name = "start_s",
            .form = "number",
            .range = kDuration,
            .unit = "s",
            .fallback = number_text(Gait{}.start),
            .meaning = "time with all feet in contact before the first stride"});
  gait.add({.name = "settle_s",
            .form = "number",
            .range = kDuration,
            .unit = "s",
            .fallback = number_text(Gait{}.settle),
            .meaning = "time with all feet in contact after the last landing"});
  gait.add({.name = "surface",
            .form = "string",
            .fallback = "the first surface",
            .meaning = "name of the surface that the feet touch"});
  gait.add({.name = "intervals_per_second",
            .form = "number",
            .range = kPositive,
            .unit = "1/s",
            .fallback = "chosen and refined by Prowl",
            .meaning = "mesh intervals per second; at least 2 in each phase"});
}

void add_goal(FileKeys& keys) {
  Table goal(keys, "goal");
  goal.add({.name = "time_s",
            .form = "number",
            .range = kPositive,
            .unit = "s",
            .fallback = "the end of the motion",
            .meaning = "time of the goal, at a node if the phases have intervals; either this or phase"});
  goal.add({.name = "phase", .form = "string", .meaning = "the goal holds at the end of the phase with this name"});
  goal.add({.name = "fraction",
            .form = "number",
            .range = {.lower = 0.0, .upper = 1.0},
            .unit = "-",
            .fallback = "1",
            .meaning = "part of the phase at which the goal holds, at a node if it has intervals, instead of its end"});
  goal.add({.name = "base_position_m", .form = kBounds3, .unit = "m", .meaning = "position of the base, world frame"});
  goal.add({.name = "base_displacement_m",
            .form = kBounds3,
            .unit = "m",
            .meaning = "displacement of the base from the start, world axes"});
  goal.add({.name = "base_rpy_rad",
            .form = "3 x (number or \"free\")",
            .range = kAngle,
            .unit = "rad",
            .meaning = "orientation of the base, as in [start]; a free angle lets the base turn about that axis of its "
                       "goal orientation"});
  goal.add({.name = "base_linear_velocity_mps",
            .form = kBounds3,
            .unit = "m/s",
            .meaning = "velocity of the base, base frame"});
  goal.add({.name = "base_angular_velocity_radps",
            .form = kBounds3,
            .unit = "rad/s",
            .meaning = "angular velocity of the base, base frame"});
  goal.add({.name = "joints", .form = kJointBounds, .unit = "rad", .meaning = "joint positions"});
  goal.add({.name = "joint_velocity_radps", .form = kJointBounds, .unit = "rad/s", .meaning = "joint velocities"});
  goal.add({.name = "torque_Nm", .form = kJointBounds, .unit = "N m", .meaning = "joint torques"});
}

void add_term(FileKeys& keys) {
  Table term(keys, "term");
  term.add({.name = "name", .form = "string", .fallback = "term 1, ...", .meaning = "name for messages"});
  term.add({.name = "frame",
            .form = "string",
            .meaning = "link of the URDF, or \"base\", for the keys from position_m to points_at_m"});
  term.add({.name = "relative_to",
            .form = "string",
            .fallback = "the world",
            .meaning = "another frame, in whose axes position_m and orientation_rpy_rad are"});
  term.add({.name = "position_m",
            .form = kOneSidedBounds3,
            .unit = "m",
            .meaning = "position of the frame's origin",
            .formula = "R_oᵀ (p - p_o), o: relative_to"});
  term.add({.name = "orientation_rpy_rad",
            .form = "3 numbers",
            .range = kAngle,
            .unit = "rad",
            .meaning =
                "orientation of the frame, R = Rz(yaw) Ry(pitch) Rx(roll); for a frame that is level and free to "
                "turn, axis and points_along",
            .formula = "log(R_refᵀ R_oᵀ R)"});
  term.add({.name = "velocity_mps",
            .form = kOneSidedBounds3,
            .unit = "m/s",
            .meaning = "velocity of the frame's origin, world axes",
            .formula = "dp/dt"});
  term.add({.name = "angular_velocity_radps",
            .form = kOneSidedBounds3,
            .unit = "rad/s",
            .meaning = "angular velocity of the frame, world axes",
            .formula = "ω"});
  term.add({.name = "points_along",
            .form = "3 numbers",
            .meaning = "direction in the world, of any length but zero, of the frame's axis",
            .formula = "rotation vector from R axis to the direction, along two unit vectors across the axis"});
  term.add({.name = "points_at_m",
            .form = "3 numbers",
            .unit = "m",
            .meaning = "point of the world at which the frame's axis points",
            .formula = "as of points_along, with the direction point - p"});
  term.add({.name = "axis", .form = "3 numbers", .meaning = "axis of the frame for points_along and points_at_m"});
  term.add({.name = "within_rad",
            .form = "number",
            .range = {.lower = 0.0, .upper = 3.0},
            .unit = "rad",
            .fallback = "0",
            .meaning =
                "largest angle from orientation_rpy_rad about each of its axes, or from the direction about each "
                "of two axes across it"});
  term.add({.name = "com_m",
            .form = kOneSidedBounds3,
            .unit = "m",
            .meaning = "centre of mass of the robot, world frame",
            .formula = "c = Σ m_i c_i / Σ m_i"});
  term.add({.name = "com_velocity_mps",
            .form = kOneSidedBounds3,
            .unit = "m/s",
            .meaning = "its velocity, world axes",
            .formula = "dc/dt"});
  term.add({.name = "angular_momentum_Nms",
            .form = kOneSidedBounds3,
            .unit = "N m s",
            .meaning = "of the robot about its centre of mass, world axes",
            .formula = "Σ I_i ω_i + (c_i - c) × m_i dc_i/dt"});
  term.add(
      {.name = "joints", .form = kOneSidedJointBounds, .unit = "rad", .meaning = "joint positions", .formula = "q_i"});
  term.add({.name = "joint_velocity_radps",
            .form = kOneSidedJointBounds,
            .unit = "rad/s",
            .meaning = "joint velocities",
            .formula = "dq_i/dt"});
  term.add({.name = "joint_torque_Nm",
            .form = kOneSidedJointBounds,
            .unit = "N m",
            .meaning = "torques on the joints' links",
            .formula = "τ_i"});
  term.add({.name = "contact", .form = "string", .meaning = "contact of the robot, for force_N"});
  term.add({.name = "force_N",
            .form = kOneSidedBounds3,
            .unit = "N",
            .meaning = "force of the ground on the contact, world axes; zero while it is open",
            .formula = "f"});
  term.add({.name = "own",
            .form = "string",
            .meaning = "name of a term of your own, from the library or from the program that reads this file",
            .formula = "f(y)"});
  term.add({.name = "library",
            .form = "string",
            .fallback = "none",
            .meaning = "shared library that defines it, relative to this file; needs --allow-libraries"});
  term.add({.name = "value",
            .form = "list of (number, \"free\" or [min, max]; min or max may be \"free\")",
            .unit = "its own",
            .meaning = "one entry for each row of a term of your own"});
  term.add({.name = "weight",
            .form = kOneOrThree,
            .range = kNonnegative,
            .unit = "1/unit²",
            .fallback = "none: the term is a limit",
            .meaning =
                "makes the term a cost: half of weight x (value - number)², integrated over time, or once at one "
                "moment"});
  term.add({.name = "weight_matrix",
            .form = "rows of numbers",
            .unit = "1/unit²",
            .fallback = "none",
            .meaning =
                "in place of weight: half of (value - number)ᵀ W (value - number), with W symmetric and positive "
                "semidefinite, a row and a column for each entry of the value"});
  term.add({.name = "time_s",
            .form = kOneOrRange,
            .range = kNonnegative,
            .unit = "s",
            .fallback = "the whole motion",
            .meaning = "moment, or span of time, at nodes if the phases have intervals; either this or phase"});
  term.add({.name = "phase", .form = "string", .meaning = "the term holds during the phase with this name"});
  term.add({.name = "fraction",
            .form = kOneOrRange,
            .range = {.lower = 0.0, .upper = 1.0},
            .unit = "-",
            .fallback = "the whole phase",
            .meaning = "part of the phase, as time_s"});
}

/// A cost weight; default 0.
FileKey weight(const char* name, const char* form, const char* unit, const char* meaning) {
  return {.name = name, .form = form, .range = kNonnegative, .unit = unit, .fallback = "0", .meaning = meaning};
}

void add_reference(FileKeys& keys) {
  Table reference(keys, "reference");
  reference.add({.name = "file",
                 .form = "string",
                 .meaning =
                     "CSV file of the motion, relative to the task file, with columns of a plan's trajectory.csv: "
                     "time_s, base_px_m to base_qw, q_JOINT_rad of all joints"});
  reference.add(weight("base_position", kOneOrThree, "1/m²", "weight on the position of the base, world x y z"));
  reference.add(weight("base_orientation", "number", "1/rad²",
                       "weight on the orientation of the base; for an angle φ the squared deviation is 2 - 2 cos φ"));
  reference.add(weight("joint_position", kOneOrJoints, "1/rad²", "weight on joint positions"));
  reference.add(
      {.name = "frame", .form = "[[reference.frame]]", .meaning = "weights on positions of frames, such as feet"});
  Table frame(keys, "reference.frame");
  frame.add({.name = "frame", .form = "string", .meaning = "link of the URDF"});
  frame.add({.name = "weight",
             .form = "number",
             .range = kNonnegative,
             .unit = "1/m²",
             .meaning = "weight on the position of its origin"});
}

/// Weights common to running and terminal cost, in table `name`.
void add_state_weights(FileKeys& keys, const std::string& name) {
  Table cost(keys, name);
  cost.add({.name = "reference",
            .choices = {"start", "goal"},
            .fallback = "\"start\"",
            .meaning = "configuration that the position weights pull to: that of the start or of the last goal"});
  cost.add(weight("base_position", kOneOrThree, "1/m²", "weight on the displacement of the base, world x y z"));
  cost.add(weight("base_orientation", kOneOrThree, "1/rad²",
                  "weight on the rotation vector of the base, x y z of the base"));
  cost.add(weight("joint_position", kOneOrJoints, "1/rad²", "weight on joint positions"));
  cost.add(
      weight("base_linear_velocity", kOneOrThree, "s²/m²", "weight on the linear velocity of the base, base frame"));
  cost.add(weight("base_angular_velocity", kOneOrThree, "s²/rad²",
                  "weight on the angular velocity of the base, base frame"));
  cost.add(weight("joint_velocity", kOneOrJoints, "s²/rad²", "weight on joint velocities"));
  cost.add({.name = "contact_position",
            .form = "[[" + name + ".contact_position]]",
            .meaning = "weights on positions of contacts"});

  Table position(keys, name + ".contact_position");
  position.add({.name = "contact", .form = "string", .meaning = "name of the contact"});
  position.add({.name = "reference_m",
                .form = "3 numbers",
                .unit = "m",
                .meaning = "position that the weight pulls to, world frame"});
  position.add({.name = "weight",
                .form = kOneOrThree,
                .range = kNonnegative,
                .unit = "1/m²",
                .meaning = "weight on the distance to reference_m, world x y z"});
}

void add_running_weights(FileKeys& keys) {
  Table cost(keys, "cost");
  cost.add(weight("base_linear_acceleration", kOneOrThree, "s⁴/m²",
                  "weight on the linear acceleration of the base, base frame"));
  cost.add(weight("base_angular_acceleration", kOneOrThree, "s⁴/rad²",
                  "weight on the angular acceleration of the base, base frame"));
  cost.add(weight("joint_acceleration", kOneOrJoints, "s⁴/rad²", "weight on joint accelerations"));
  cost.add(weight("torque", kOneOrJoints, "1/(N m)²", "weight on torques minus torque_reference"));
  cost.add(weight("peak_torque", "number", "1/s",
                  "half of weight x (torque / limit)⁸, over all joints with a limit: the largest torques shrink most"));
  cost.add({.name = "torque_reference",
            .choices = {"static", "zero"},
            .fallback = "\"static\"",
            .meaning =
                "torques at zero cost: those that hold the start posture on the contacts of the first phase, or zero"});
  cost.add(weight("time", "number", "1/s", "cost per second, for phases of free duration"));
  cost.add(weight("force", kOneOrThree, "1/N²", "weight on the force of every contact, world x y z"));
}

void add_solver(FileKeys& keys) {
  const SolverOptions defaults;
  Table solver(keys, "solver");
  solver.add({.name = "tolerance",
              .form = "number",
              .range = {.lower = 1e-12, .upper = 1e-2},
              .fallback = number_text(defaults.tolerance),
              .meaning = "tolerance on optimality and on the constraints"});
  solver.add({.name = "max_iterations",
              .form = "integer",
              .range = {.lower = 1},
              .fallback = number_text(defaults.max_iterations),
              .meaning = "stop after this many iterations, on each mesh"});
  solver.add({.name = "max_time_s",
              .form = "number",
              .range = kPositive,
              .unit = "s",
              .fallback = number_text(defaults.max_seconds),
              .meaning = "stop after this much wall-clock time"});
}

void add_tracking(FileKeys& keys) {
  const TrackingOptions defaults;
  constexpr DefaultDeviations deviations;
  Table tracking(keys, "tracking");
  const auto add_deviation = [&](const char* name, const char* form, const char* unit, double deviation,
                                 const char* meaning) {
    tracking.add({.name = name,
                  .form = form,
                  .range = kDeviation,
                  .unit = unit,
                  .fallback = number_text(deviation),
                  .meaning = meaning});
  };
  tracking.add({.name = "step_s",
                .form = "number",
                .range = {.lower = 1e-4, .upper = 0.1},
                .unit = "s",
                .fallback = number_text(defaults.step),
                .meaning = "time between two samples of the gains"});
  add_deviation("base_position_m", kOneOrThree, "m", deviations.base_position,
                "deviation that costs 1 per second; a smaller value makes the robot stiffer");
  add_deviation("base_orientation_rad", kOneOrThree, "rad", deviations.base_orientation,
                "deviation that costs 1 per second, about the axes of the base");
  add_deviation("joint_position_rad", kOneOrJoints, "rad", deviations.joint_position,
                "deviation that costs 1 per second; a smaller value makes the robot stiffer");
  add_deviation("base_linear_velocity_mps", kOneOrThree, "m/s", deviations.base_linear_velocity,
                "deviation that costs 1 per second, base frame");
  add_deviation("base_angular_velocity_radps", kOneOrThree, "rad/s", deviations.base_angular_velocity,
                "deviation that costs 1 per second, base frame");
  add_deviation("joint_velocity_radps", kOneOrJoints, "rad/s", deviations.joint_velocity,
                "deviation that costs 1 per second; a smaller value makes the robot stiffer");
  add_deviation("torque_share", "number", "-", deviations.torque_share,
                "torque that costs 1 per second, as a share of the limit; without a limit, of the weight of the robot "
                "times the reach of its legs");
  add_deviation("swing_foot_m", "number", "m", deviations.swing_foot,
                "deviation of each foot that will land, each axis, that costs 1 per second");
  tracking.add({.name = "landing_s",
                .form = "number",
                .range = kNonnegative,
                .unit = "s",
                .fallback = number_text(defaults.landing_time),
                .meaning = "time for which a foot that landed beside its foothold costs"});
  tracking.add({.name = "goal_s",
                .form = "number",
                .range = kNonnegative,
                .unit = "s",
                .fallback = number_text(defaults.goal_time),
                .meaning = "time for which a deviation at a goal of the posture costs"});
  tracking.add({.name = "bandwidth_radps",
                .form = "number",
                .range = kPositive,
                .unit = "rad/s",
                .fallback = number_text(defaults.largest_bandwidth),
                .meaning = "largest bandwidth of the feedback; faster gains are reduced to it"});
}

void add_robust(FileKeys& keys) {
  Table robust(keys, "robust");
  const auto add = [&](const char* name, const char* unit, NumberRange range, double fallback, const char* meaning,
                       const char* scaled = "") {
    robust.add({.name = name,
                .form = "number",
                .range = range,
                .unit = unit,
                .fallback = number_text(fallback) + scaled,
                .meaning = meaning});
  };
  constexpr Disturbances sizes = kSweptDisturbances;
  const char* const as_length = ", scaled with the height";
  const char* const as_velocity = ", scaled with the root of the height";
  const auto up_to = [](double most) { return NumberRange{.lower = 0.0, .upper = most}; };
  add("base_position_m", "m", up_to(0.2), sizes.base_position,
      "largest error of the base's position at the start, each axis", as_length);
  add("base_angle_rad", "rad", up_to(0.5), sizes.base_angle,
      "largest error of the base's orientation at the start, about each axis");
  add("base_velocity_mps", "m/s", up_to(1.0), sizes.base_velocity,
      "largest error of the base's linear velocity at the start, each axis", as_velocity);
  add("base_rate_radps", "rad/s", up_to(2.0), sizes.base_rate,
      "largest error of the base's angular velocity at the start, each axis");
  add("mass", "-", up_to(0.9), sizes.mass, "largest error of mass and inertia of each body, as a share");
  add("center_m", "m", up_to(0.2), sizes.center, "largest error of the base's centre of mass, each axis", as_length);
  add("friction", "-", up_to(0.9), sizes.friction, "share of the friction coefficients that may be missing");
  add("push_mps", "m/s", up_to(2.0), sizes.push,
      "change of the robot's velocity by one horizontal push on the base, at its worst time", as_velocity);
  add("push_s", "s", {.lower = 0.01, .upper = 1.0}, sizes.push_duration, "duration of that push");
  add("ground_m", "m", up_to(0.1), sizes.ground,
      "error of the ground's height under each foot, at two standard deviations", as_length);
  add("estimate_position_m", "m", up_to(0.2), sizes.estimate_position,
      "largest error of the base's estimated position, each axis, the whole time", as_length);
  add("estimate_angle_rad", "rad", up_to(0.5), sizes.estimate_angle,
      "largest error of the base's estimated orientation, about each axis, the whole time");
}

void add_simulation(FileKeys& keys) {
  const SuccessCriteria defaults;
  Table simulation(keys, "simulation");
  const auto add = [&](const char* name, const char* unit, const std::string& fallback, const char* meaning) {
    simulation.add(
        {.name = name, .form = "number", .range = kPositive, .unit = unit, .fallback = fallback, .meaning = meaning});
  };
  add("base_position_m", "m", number_text(defaults.position),
      "largest distance of the base at rest from the end of the plan");
  add("base_angle_rad", "rad", number_text(defaults.angle),
      "largest angle of the base at rest from the end of the plan");
  add("slip_m", "m", number_text(defaults.distance),
      "largest slip of a foot in contact, and largest distance of a landing from its foothold");
  add("friction", "-", "that of each [[surface]]", "friction coefficient of all surfaces");
  add("rest_s", "s", number_text(defaults.rest), "time that the robot stands after the plan");
}

FileKeys make_task_file_keys() {
  FileKeys keys;
  for (const auto add :
       {add_top, add_surface, add_payload, add_start, add_phase, add_gait, add_goal, add_term, add_reference})
    add(keys);
  add_state_weights(keys, "cost");
  add_running_weights(keys);
  add_state_weights(keys, "terminal_cost");
  for (const auto add : {add_tracking, add_solver, add_robust, add_simulation}) add(keys);
  return keys;
}

FileKeys make_robot_file_keys() {
  FileKeys keys;
  Table top(keys, "");
  top.add({.name = "name", .form = "string", .meaning = "name of the robot"});
  top.add({.name = "urdf",
           .form = "path or package://...",
           .meaning = "URDF of the robot; a path is relative to this file"});
  top.add({.name = "package_dirs",
           .form = "list of paths",
           .fallback = "none",
           .meaning = "folders to search first for package://, relative to this file"});
  top.add({.name = "contact",
           .form = "[[contact]], one or more",
           .meaning = "points of the robot that may touch surfaces"});
  top.add(
      {.name = "locked_joints",
       .form = "list of names",
       .fallback = "joints with <mimic>",
       .meaning = "joints held at their nominal position, such as fingers; no contact may move with a mimic joint"});
  top.add({.name = "armature",
           .form = "{joint = number}",
           .unit = "kg m²",
           .fallback = "0",
           .meaning = "inertia of the joint's motor, times the square of its gear ratio, >= 0"});
  top.add({.name = "nominal", .form = "[nominal]", .meaning = "default posture at the start of a motion"});
  top.add({.name = "limits", .form = "[limits.JOINT]", .meaning = "limits that replace those of the URDF"});

  Table contact(keys, "contact");
  contact.add({.name = "name", .form = "string", .meaning = "name of the contact, unique in the robot"});
  contact.add(
      {.name = "frame", .form = "string", .meaning = "link or fixed joint of the URDF that carries the contact"});
  contact.add({.name = "radius_m",
               .form = "number",
               .range = kNonnegative,
               .unit = "m",
               .fallback = number_text(ContactPoint{}.radius),
               .meaning = "radius of the ball around the point"});
  contact.add({.name = "offset_m",
               .form = "3 numbers",
               .unit = "m",
               .fallback = "[0, 0, 0]",
               .meaning = "centre of the ball, in the frame"});

  Table nominal(keys, "nominal");
  nominal.add(
      {.name = "base_rpy_rad",
       .form = "3 numbers",
       .range = kAngle,
       .unit = "rad",
       .fallback = "[0, 0, 0]",
       .meaning = "orientation of the base, R = Rz(yaw) Ry(pitch) Rx(roll); its position follows from the contacts"});
  nominal.add(
      {.name = "joints", .form = "{joint = number}", .unit = "rad", .fallback = "0", .meaning = "joint positions"});

  Table limits(keys, "limits");
  limits.add({.name = "position_rad", .form = "[min, max]", .unit = "rad", .meaning = "range of the joint position"});
  limits.add({.name = "velocity_radps",
              .form = "number",
              .range = kPositive,
              .unit = "rad/s",
              .meaning = "largest joint velocity, in both directions"});
  limits.add({.name = "torque_Nm",
              .form = "number",
              .range = kPositive,
              .unit = "N m",
              .meaning = "largest joint torque, in both directions"});
  limits.add({.name = "torque_over_position",
              .form = "4 or more [position, torque]",
              .unit = "rad, N m",
              .fallback = "none",
              .meaning = "torque limit over the joint position, in both directions: a smooth curve through these "
                         "points, which cover the range"});
  limits.add({.name = "negative_torque_over_position",
              .form = "4 or more [position, torque]",
              .unit = "rad, N m",
              .fallback = "torque_over_position",
              .meaning =
                  "the same for negative torques alone, as positive numbers; torque_over_position is then that of "
                  "positive ones"});
  limits.add({.name = "torque_over_velocity",
              .form = "4 or more [velocity, torque]",
              .unit = "rad/s, N m",
              .fallback = "none",
              .meaning = "torque limit in the direction of positive velocity, over -velocity ... velocity; mirrored "
                         "for the other direction"});
  return keys;
}

}  // namespace

std::string FileKey::type() const {
  std::string text = form;
  for (const std::string& choice : choices) {
    if (!text.empty()) text += choice == choices.back() ? " or " : ", ";
    text += fmt::format("\"{}\"", choice);
  }
  if (const std::string limits = range.limits(); !limits.empty()) {
    const bool is_one = text.find(' ') == std::string::npos;
    text += is_one ? " " + limits : ", each " + limits;
  }
  return text;
}

std::string FileKey::value() const {
  std::string text = type();
  if (!unit.empty()) text += fmt::format(" [{}]", unit);
  if (!fallback.empty()) text += "; default " + fallback;
  return text;
}

const FileKeys& robot_file_keys() {
  static const FileKeys keys = make_robot_file_keys();
  return keys;
}

const FileKeys& task_file_keys() {
  static const FileKeys keys = make_task_file_keys();
  return keys;
}

const FileKey& file_key(const FileKeys& keys, const std::string& table, const std::string& name) {
  const auto found = std::find_if(keys.begin(), keys.end(),
                                  [&](const FileKey& key) { return key.table == table && key.name == name; });
  assert(found != keys.end());
  return *found;
}

std::vector<std::string> key_names(const FileKeys& keys, const std::string& table) {
  std::vector<std::string> names;
  for (const FileKey& key : keys) {
    if (key.table == table) names.push_back(key.name);
  }
  return names;
}

}  // namespace prowl
