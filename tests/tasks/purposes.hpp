#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/plan_folder/plan_folder.hpp"

/// The purpose of every shipped task: its plan beside the wishes of its file. The wishes are read from the TOML, not
/// from the problem that Prowl made of it.
namespace prowl::test {

using Eigen::Vector3d;
using Names = std::vector<std::string>;

/// What a plan misses, in words; empty if it is as it should be.
class Misses {
 public:
  void unless(bool kept, const std::string& miss) {
    if (!kept) misses_.push_back(miss);
  }
  void near(const std::string& what, double value, double wanted, double tolerance = 1e-3) {
    unless(std::abs(value - wanted) <= tolerance, fmt::format("{}: {:.4f}, wanted {:.4f}", what, value, wanted));
  }
  void at_least(const std::string& what, double value, double wanted) {
    unless(value >= wanted, fmt::format("{}: {:.4f}, wanted {:.4f} or more", what, value, wanted));
  }
  const Names& all() const { return misses_; }

 private:
  Names misses_;
};

/// A planned motion and the file of its task.
class PlannedTask {
 public:
  PlannedTask(const std::filesystem::path& task_file, const PlanRecord& record)
      : file_(toml::parse_file(task_file.string())), record_(record) {}

  const toml::table& file() const { return file_; }
  const RobotModel& robot() const { return record_.task.problem.robot; }
  std::vector<TrajectoryPoint>& nodes() { return record_.plan.trajectory.nodes; }
  const std::vector<TrajectoryPoint>& nodes() const { return record_.plan.trajectory.nodes; }
  TrajectoryPoint at(double time) const { return sample(record_.plan.trajectory, time); }
  const TrajectoryPoint& start() const { return nodes().front(); }
  const TrajectoryPoint& end() const { return nodes().back(); }

  std::vector<TrajectoryPoint> phase(const std::string& name) const {
    const auto& phases = record_.task.problem.phases;
    std::vector<TrajectoryPoint> found;
    for (const TrajectoryPoint& node : nodes()) {
      if (phases[node.phase].name == name) found.push_back(node);
    }
    if (found.empty()) throw std::logic_error("no phase " + name);
    return found;
  }
  const toml::table& phase_in_file(const std::string& name) const {
    for (const auto& phase : *file_["phase"].as_array()) {
      if ((*phase.as_table())["name"].value_or(std::string()) == name) return *phase.as_table();
    }
    throw std::logic_error("no phase " + name + " in the file");
  }

  bool stands(const TrajectoryPoint& node, const std::string& contact) const {
    const int index = robot().contact_index(contact);
    const auto& held = record_.task.problem.phases[node.phase].contacts;
    return std::ranges::any_of(held, [&](const PhaseContact& one) { return one.contact == index; });
  }
  Names contacts() const {
    Names names;
    for (const ContactPoint& contact : robot().contacts()) names.push_back(contact.name);
    return names;
  }
  Names in_the_air(const TrajectoryPoint& node) const {
    Names names = contacts();
    std::erase_if(names, [&](const std::string& name) { return stands(node, name); });
    return names;
  }
  /// Centre of a contact's ball, world frame [m].
  Vector3d contact_position(const TrajectoryPoint& node, const std::string& contact) const {
    RigidBodyTerms terms(robot());
    terms.update_kinematics(node.q);
    return terms.contact_position(robot().contact_index(contact));
  }
  Vector3d way(const std::string& contact) const {
    return contact_position(end(), contact) - contact_position(start(), contact);
  }
  /// Of a contact's ball above the first surface of the file [m].
  double height(const TrajectoryPoint& node, const std::string& contact) const {
    return normal().dot(contact_position(node, contact)) - radius(contact);
  }
  double radius(const std::string& contact) const { return robot().contacts()[robot().contact_index(contact)].radius; }
  Vector3d normal() const {
    const auto* given = file_["surface"][0]["normal"].as_array();
    return given ? vector(*given).normalized() : Vector3d::UnitZ();
  }
  Vector3d force(const TrajectoryPoint& node, const std::string& contact) const {
    return node.force.segment<3>(3 * robot().contact_index(contact));
  }
  Vector3d displacement(const TrajectoryPoint& node) const { return base_position(node.q) - base_position(start().q); }
  /// Roll, pitch, yaw [rad].
  static Vector3d angles(const TrajectoryPoint& node) { return rpy_from_rotation(base_rotation(node.q)); }

  /// The node that the i-th [[goal]] of the file means.
  const TrajectoryPoint& at_goal(std::size_t i) const {
    const auto goal = file_["goal"][i];
    double time = goal["time_s"].value_or(0.0);
    if (const auto name = goal["phase"].value<std::string>()) {
      const auto nodes_of_phase = phase(*name);
      const double first = nodes_of_phase.front().time, last = nodes_of_phase.back().time;
      time = first + goal["fraction"].value_or(1.0) * (last - first);
    }
    const auto off = [&](const TrajectoryPoint& node) { return std::abs(node.time - time); };
    const auto found = std::ranges::min_element(nodes(), {}, off);
    if (off(*found) > 1e-6) throw std::logic_error(fmt::format("no node at goal {}", i + 1));
    return *found;
  }
  double asked(std::size_t goal, const char* key, std::size_t axis) const {
    return file_["goal"][goal][key][axis].value<double>().value();
  }
  /// Over the ground, that a contact in the air has to reach; docs/reference.md has the default.
  double clearance() const { return file_["swing_clearance_m"].value_or(0.05 * robot().nominal_configuration()(2)); }
  static Vector3d vector(const toml::array& array) {
    return {array[0].value<double>().value(), array[1].value<double>().value(), array[2].value<double>().value()};
  }

 private:
  toml::table file_;
  PlanRecord record_;
};

using Purpose = std::function<void(const PlannedTask&, Misses&)>;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Every number and range of every [[goal]] of the file.
inline void reaches_its_goals(const PlannedTask& task, Misses& misses) {
  const auto* goals = task.file()["goal"].as_array();
  for (std::size_t i = 0; goals && i < goals->size(); ++i) {
    const TrajectoryPoint& node = task.at_goal(i);
    const std::map<std::string, Vector3d> reached{{"base_displacement_m", task.displacement(node)},
                                                  {"base_rpy_rad", PlannedTask::angles(node)},
                                                  {"base_linear_velocity_mps", node.v.head<3>()},
                                                  {"base_angular_velocity_radps", node.v.segment<3>(3)}};
    int numbers = 0;
    for (const auto& [key, value] : reached) {
      const auto wish = task.file()["goal"][i][key];
      for (std::size_t axis = 0; wish && axis < 3; ++axis) {
        if (wish[axis].is_string()) continue;  // "free"
        const double low = wish[axis].is_array() ? wish[axis][0].value<double>().value() : *wish[axis].value<double>();
        const double high = wish[axis].is_array() ? wish[axis][1].value<double>().value() : low;
        const double at = value(static_cast<Eigen::Index>(axis));
        misses.near(fmt::format("goal {}, {}[{}]", i + 1, key, axis), at, std::clamp(at, low, high));
        ++numbers;
      }
    }
    misses.unless(numbers > 0, fmt::format("goal {} asks for nothing that is looked at here", i + 1));
  }
}

/// No contact leaves its place, in all of the motion.
inline void keeps_its_feet(const PlannedTask& task, Misses& misses) {
  for (const std::string& contact : task.contacts()) {
    double farthest = 0.0;
    for (const TrajectoryPoint& node : task.nodes()) {
      farthest = std::max(farthest,
                          (task.contact_position(node, contact) - task.contact_position(task.start(), contact)).norm());
    }
    misses.near("way of " + contact, farthest, 0.0);
  }
}

/// All contacts are down at the end, the base at rest.
inline void ends_on_all_feet(const PlannedTask& task, Misses& misses) {
  for (const std::string& contact : task.contacts()) {
    misses.unless(task.stands(task.end(), contact), contact + " is in the air at the end");
    misses.near("height of " + contact + " at the end", task.height(task.end(), contact), 0.0);
  }
  misses.near("velocity of the base at the end", task.end().v.head<6>().norm(), 0.0, 5e-3);
}

/// Each of these contacts gets over its clearance.
inline void swings_clear(const PlannedTask& task, const std::vector<TrajectoryPoint>& nodes, const Names& contacts,
                         Misses& misses) {
  for (const std::string& contact : contacts) {
    double highest = -1.0;
    for (const TrajectoryPoint& node : nodes) highest = std::max(highest, task.height(node, contact));
    misses.at_least("height of " + contact, highest, 0.9 * task.clearance());
  }
}

inline void stands_still(const PlannedTask& task, Misses& misses) {
  misses.near("duration", task.end().time, task.file()["phase"][0]["duration_s"].value<double>().value(), 1e-9);
  for (const TrajectoryPoint& node : task.nodes()) {
    misses.near(fmt::format("posture off the start at {:.2f} s", node.time),
                difference(task.start().q, node.q).cwiseAbs().maxCoeff(), 0.0);
  }
}

inline void moves_and_turns(const PlannedTask& task, Misses& misses) {
  keeps_its_feet(task, misses);
  reaches_its_goals(task, misses);
  for (const Eigen::Index axis : {0, 1, 2}) {
    misses.at_least(fmt::format("displacement[{}]", axis), std::abs(task.displacement(task.end())(axis)), 0.009);
    misses.at_least(fmt::format("turn[{}]", axis), std::abs(PlannedTask::angles(task.end())(axis)), 0.049);
  }
}

inline void goes_down_and_up(const PlannedTask& task, Misses& misses) {
  keeps_its_feet(task, misses);
  reaches_its_goals(task, misses);
  const auto rise = [&](const TrajectoryPoint& node) { return task.displacement(node).z(); };
  const double lowest = rise(*std::ranges::min_element(task.nodes(), {}, rise));
  misses.near("lowest", lowest, task.asked(0, "base_displacement_m", 2), 2e-3);
  misses.at_least("depth", -lowest, 0.05);
  misses.near("height at the end", rise(task.end()), 0.0);
}

/// `contacts` go `far` forward, over the ground: the first one to the place of the file, a foot with several may turn
/// about it. All others stay.
inline Purpose steps(const Names& contacts, double far) {
  return [=](const PlannedTask& task, Misses& misses) {
    reaches_its_goals(task, misses);
    ends_on_all_feet(task, misses);
    swings_clear(task, task.phase("swing"), contacts, misses);
    const auto landing = task.phase_in_file("settle")["contacts"][0];
    misses.unless(landing["contact"] == contacts.front(), "the file has a place for another contact");
    Vector3d foothold = PlannedTask::vector(*landing["place_m"].as_array());
    foothold.z() += task.radius(contacts.front());
    misses.near("landing from its place", (task.contact_position(task.end(), contacts.front()) - foothold).norm(), 0.0);
    misses.near("way of " + contacts.front(), task.way(contacts.front()).x(), far);
    for (const std::string& contact : task.contacts()) {
      misses.near("height of " + contact + " at the start", task.height(task.start(), contact), 0.0);
      if (std::ranges::find(contacts, contact) == contacts.end()) {
        misses.near("way of " + contact, task.way(contact).norm(), 0.0);
      } else {
        misses.at_least("way of " + contact, task.way(contact).x(), 0.9 * far);
      }
    }
  };
}

/// The base goes as far along the surface as the gait of the file says; `at_once` feet swing at a time, every foot once
/// a stride and clear of the ground. Of two feet at once, one is fore and left, the other hind and right, or the
/// mirror of that.
inline Purpose strides(std::size_t at_once) {
  return [=](const PlannedTask& task, Misses& misses) {
    const auto gait = task.file()["gait"];
    const auto count = gait["strides"].value<int>().value();
    const double far = count * gait["stride_length_m"].value<double>().value();
    const Vector3d across = Vector3d::UnitY(), along = across.cross(task.normal());
    misses.near("way of the base to where it should be", (task.displacement(task.end()) - far * along).norm(), 0.0);
    ends_on_all_feet(task, misses);

    const auto side = [&](const std::string& foot) {
      Vector3d middle = Vector3d::Zero();
      for (const std::string& each : task.contacts()) middle += task.contact_position(task.start(), each) / 4.0;
      const Vector3d from_middle = task.contact_position(task.start(), foot) - middle;
      return std::pair(from_middle.dot(along) > 0.0, from_middle.y() > 0.0);
    };
    std::size_t most = 0;
    for (const TrajectoryPoint& node : task.nodes()) {
      const Names feet = task.in_the_air(node);
      most = std::max(most, feet.size());
      if (feet.size() != 2) continue;
      const auto [a_fore, a_left] = side(feet[0]);
      const auto [b_fore, b_left] = side(feet[1]);
      misses.unless(a_fore != b_fore && a_left != b_left, fmt::format("not diagonal: {}", fmt::join(feet, ", ")));
    }
    misses.unless(most == at_once, fmt::format("{} feet in the air at once, wanted {}", most, at_once));
    for (const std::string& foot : task.contacts()) {
      std::vector<std::vector<TrajectoryPoint>> swings;
      bool stood = true;
      for (const TrajectoryPoint& node : task.nodes()) {
        if (!task.stands(node, foot)) {
          if (stood) swings.emplace_back();
          swings.back().push_back(node);
        }
        stood = task.stands(node, foot);
      }
      misses.unless(static_cast<int>(swings.size()) == count, fmt::format("{} swings {} times", foot, swings.size()));
      for (const auto& swing : swings) swings_clear(task, swing, {foot}, misses);
      misses.unless(task.way(foot).dot(along) > 0.0, foot + " does not go forward");
    }
  };
}

inline void balances_on_two_feet(const PlannedTask& task, Misses& misses) {
  const auto two_feet = task.phase("two feet");
  const toml::table& wish = task.phase_in_file("two feet");
  Names lifted = task.contacts();
  for (const auto& standing : *wish["contacts"].as_array()) std::erase(lifted, standing.value_or(std::string()));
  misses.unless(lifted.size() == 2 && lifted == task.in_the_air(two_feet.front()), "other feet are in the air");
  const double asked = wish["duration_s"].value<double>().value();
  misses.near("time in the air", two_feet.back().time - two_feet.front().time, asked, 1e-6);
  misses.at_least("time in the air", asked, 0.5 - 1e-6);
  swings_clear(task, two_feet, lifted, misses);
  ends_on_all_feet(task, misses);
  reaches_its_goals(task, misses);
}

inline void rears(const PlannedTask& task, Misses& misses) {
  const auto on_hind_legs = task.phase("rear");
  double steepest = 0.0;  // nose up
  for (const TrajectoryPoint& node : on_hind_legs) steepest = std::max(steepest, -PlannedTask::angles(node).y());
  misses.at_least("pitch, nose up", steepest, 15.0 * kDegree);
  misses.at_least("pitch, nose up", steepest, -task.asked(0, "base_rpy_rad", 1) - 1e-3);
  swings_clear(task, on_hind_legs, {"lf_foot", "rf_foot"}, misses);
  for (const std::string& foot : Names{"lh_foot", "rh_foot"}) {
    for (const TrajectoryPoint& node : on_hind_legs) misses.near("height of " + foot, task.height(node, foot), 0.0);
  }
  ends_on_all_feet(task, misses);
  reaches_its_goals(task, misses);
}

inline void leans_on_the_wall(const PlannedTask& task, Misses& misses) {
  const auto contact = task.phase_in_file("lean")["contacts"][0];
  const Vector3d outwards = PlannedTask::vector(*task.file()["surface"][1]["normal"].as_array());
  Vector3d foothold = PlannedTask::vector(*contact["place_m"].as_array());
  foothold += outwards * task.radius("lf_foot");
  for (const TrajectoryPoint& node : task.phase("lean")) {
    const std::string when = fmt::format(" at {:.2f} s", node.time);
    misses.near("lf_foot from its place on the wall" + when, (task.contact_position(node, "lf_foot") - foothold).norm(),
                0.0);
    misses.at_least("push of the wall [N]" + when, task.force(node, "lf_foot").dot(outwards), 50.0);
  }
  misses.at_least("way forward", task.displacement(task.end()).x(), 0.08 - 1e-3);
  reaches_its_goals(task, misses);
}

inline void moves_on_its_knees(const PlannedTask& task, Misses& misses) {
  misses.unless(task.contacts().size() == 6, "not four feet and two knees");
  misses.unless(task.in_the_air(task.start()).empty(), "a foot or knee is in the air");
  for (const std::string& contact : task.contacts()) {
    misses.near("height of " + contact, task.height(task.start(), contact), 0.0);
  }
  keeps_its_feet(task, misses);
  misses.near("way forward", task.displacement(task.end()).x(), 0.06);
  reaches_its_goals(task, misses);
}

inline void jumps(const PlannedTask& task, Misses& misses) {
  const auto flight = task.phase("flight");
  const double shortest = task.phase_in_file("flight")["duration_s"][0].value<double>().value();
  misses.at_least("time in the air", flight.back().time - flight.front().time, std::max(0.2, shortest) - 1e-6);
  const TrajectoryPoint middle = task.at(0.5 * (flight.front().time + flight.back().time));
  for (const std::string& foot : task.contacts()) {
    misses.at_least("height of " + foot, task.height(middle, foot), task.clearance() - 1e-3);
    misses.at_least("height of " + foot, task.height(middle, foot), 0.15 - 1e-3);
  }
  misses.unless(task.in_the_air(middle).size() == 4, "not all feet are in the air");
  ends_on_all_feet(task, misses);
  reaches_its_goals(task, misses);
}

inline void shifts_its_weight(const PlannedTask& task, Misses& misses) {
  keeps_its_feet(task, misses);
  reaches_its_goals(task, misses);
  const auto aside = [&](const TrajectoryPoint& node) { return task.displacement(node).y(); };
  misses.at_least("to the left", aside(*std::ranges::max_element(task.nodes(), {}, aside)), 0.06 - 1e-3);
  misses.at_least("to the right", -aside(*std::ranges::min_element(task.nodes(), {}, aside)), 0.06 - 1e-3);
  misses.near("at the end", aside(task.end()), 0.0);
}

inline const Names kLeftSole = {"left_front_left", "left_front_right", "left_rear_left", "left_rear_right"};

inline const std::map<std::string, Purpose> kPurposes{
    {"hyq/hold", stands_still},
    {"hyq/stand", moves_and_turns},
    {"anymal_c/stand", moves_and_turns},
    {"go2/stand", moves_and_turns},
    {"solo12/stand", moves_and_turns},
    {"hyq/crouch", goes_down_and_up},
    {"anymal_c/crouch", goes_down_and_up},
    {"go2/crouch", goes_down_and_up},
    {"solo12/crouch", goes_down_and_up},
    {"talos/squat", goes_down_and_up},
    {"hyq/step", steps({"lf_foot"}, 0.20)},
    {"anymal_c/step", steps({"LF_FOOT"}, 0.15)},
    {"go2/step", steps({"FL_foot"}, 0.10)},
    {"solo12/step", steps({"FL_FOOT"}, 0.08)},
    {"talos/step", steps(kLeftSole, 0.10)},
    {"hyq/trot", strides(2)},
    {"anymal_c/trot", strides(2)},
    {"go2/trot", strides(2)},
    {"solo12/trot", strides(2)},
    {"hyq/walk", strides(1)},
    {"hyq/slope", strides(1)},
    {"hyq/balance", balances_on_two_feet},
    {"hyq/rear", rears},
    {"hyq/wall", leans_on_the_wall},
    {"hyq/kneel", moves_on_its_knees},
    {"hyq/jump", jumps},
    {"talos/weight_shift", shifts_its_weight},
};

inline Names misses_of(const std::string& name, const PlannedTask& task) {
  Misses misses;
  kPurposes.at(name)(task, misses);
  return misses.all();
}

}  // namespace prowl::test
