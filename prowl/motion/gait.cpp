#include "prowl/motion/gait.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {

namespace {

using Eigen::Vector3d;

/// Builds the list of phases.
class PhaseList {
 public:
  PhaseList(const Gait& gait, const RobotModel& robot, const Feet& feet) : gait_(gait), robot_(robot), feet_(feet) {}

  /// Adds a phase in which all contacts stand except those of these feet.
  void add(std::string name, const std::vector<Foot>& swinging, const Duration& duration) {
    Phase phase;
    phase.name = std::move(name);
    phase.duration = duration;
    for (int contact = 0; contact < static_cast<int>(robot_.contacts().size()); ++contact) {
      const auto is_contact = [&](Foot foot) { return feet_[static_cast<std::size_t>(foot)] == contact; };
      if (std::ranges::none_of(swinging, is_contact)) phase.contacts.push_back({contact, gait_.surface});
    }
    phases_.push_back(std::move(phase));
  }

  Duration share(double part) const { return {part * gait_.stride.min, part * gait_.stride.max}; }

  /// "lf_foot and rh_foot swing", "lh_foot swings"
  std::string sentence(const std::vector<Foot>& group, const std::string& verb) const {
    std::string names;
    for (const Foot foot : group) {
      const auto contact = static_cast<std::size_t>(feet_[static_cast<std::size_t>(foot)]);
      names += (names.empty() ? "" : " and ") + robot_.contacts()[contact].name;
    }
    return names + " " + verb + (group.size() == 1 ? "s" : "");
  }

  std::vector<Phase> take() { return std::move(phases_); }

 private:
  const Gait& gait_;
  const RobotModel& robot_;
  const Feet& feet_;
  std::vector<Phase> phases_;
};

/// Half of the time in which all feet stand after a swing [strides].
double half_stand(const Gait& gait) { return 0.5 * (gait.duty_factor - gait.pattern.least_duty_factor()); }

}  // namespace

std::optional<Feet> find_feet(const RobotModel& robot) {
  if (robot.contacts().size() != 4) return std::nullopt;
  RigidBodyTerms terms(robot);
  terms.update_kinematics(robot.nominal_configuration());
  // Axes of the base, not of the world: the nominal posture may have any yaw.
  const Eigen::Matrix3d to_base = base_rotation(robot.nominal_configuration()).transpose();
  std::array<Vector3d, 4> positions;
  Vector3d middle = Vector3d::Zero();
  for (int contact = 0; contact < 4; ++contact) {
    positions[contact] = to_base * terms.contact_position(contact);
    middle += positions[contact] / 4.0;
  }
  Feet feet = {-1, -1, -1, -1};
  for (int contact = 0; contact < 4; ++contact) {
    const Vector3d from_middle = positions[contact] - middle;
    const bool fore = from_middle.x() > 0.0, left = from_middle.y() > 0.0;
    const Foot foot = fore ? (left ? Foot::lf : Foot::rf) : (left ? Foot::lh : Foot::rh);
    int& index = feet[static_cast<std::size_t>(foot)];
    if (index >= 0) return std::nullopt;
    index = contact;
  }
  return feet;
}

const std::vector<GaitPattern>& gait_patterns() {
  using enum Foot;
  // A duty factor above the least leaves time in which all feet stand. Without it, standing feet would lose their force
  // at the moment at which the next ones land.
  static const std::vector<GaitPattern> patterns = {
      {"walk", {{lh}, {lf}, {rh}, {rf}}, 0.8, 0.65, 6.0, 1.6}, {"trot", {{lf, rh}, {rf, lh}}, 0.6, 0.55, 3.2, 1.2},
      {"pace", {{lf, lh}, {rf, rh}}, 0.6, 0.6, 2.8, 1.0},      {"bound", {{lh, rh}, {lf, rf}}, 0.6, 0.3, 2.8, 1.0},
      {"pronk", {{lf, rf, lh, rh}}, 0.7, 0.7, 2.8, 1.0},
  };
  return patterns;
}

const GaitPattern& gait_pattern(const std::string& name) {
  return *std::ranges::find(gait_patterns(), name, &GaitPattern::name);
}

double GaitPattern::default_stride(double height, double speed) const {
  const double usual = stride * std::sqrt(height / RobotModel::kGravity);
  return speed > 0.0 ? std::min(usual, longest * height / speed) : usual;
}

double GaitPattern::default_duty_factor(double height, double speed) const {
  constexpr double kFast = 0.1;  // of sqrt(gravity height)
  return speed > kFast * std::sqrt(RobotModel::kGravity * height) ? fast_duty_factor : slow_duty_factor;
}

std::vector<Phase> expand(const Gait& gait, const RobotModel& robot, const Feet& feet, int first_stride) {
  constexpr double kShortestPhase = 1e-6;  // [s]
  const auto& swings = gait.pattern.swings;
  struct Event {
    double time;  ///< in strides
    int stride;
    std::size_t group;
    bool lifts;
  };
  std::vector<Event> events;
  for (int stride = 0; stride < gait.strides; ++stride) {
    for (std::size_t group = 0; group < swings.size(); ++group) {
      const double lift = stride + static_cast<double>(group) / static_cast<double>(swings.size());
      events.push_back({lift, stride, group, true});
      events.push_back({lift + 1.0 - gait.duty_factor, stride, group, false});
    }
  }
  std::ranges::stable_sort(events, {}, &Event::time);

  PhaseList phases(gait, robot, feet);
  phases.add("start", {}, {gait.start, gait.start});
  std::set<std::size_t> in_the_air;
  const Event* begins = nullptr;  // what the phase is named after: a lift-off rather than a landing at the same time
  for (std::size_t i = 0; i + 1 < events.size(); ++i) {
    const Event& event = events[i];
    event.lifts ? (void)in_the_air.insert(event.group) : (void)in_the_air.erase(event.group);
    if (!begins || event.lifts) begins = &event;
    const double part = events[i + 1].time - event.time;
    if (part * gait.stride.max < kShortestPhase) continue;
    std::vector<Foot> swinging;
    for (const std::size_t group : in_the_air)
      swinging.insert(swinging.end(), swings[group].begin(), swings[group].end());
    phases.add(fmt::format("stride {}: {}", first_stride + begins->stride,
                           phases.sentence(swings[begins->group], begins->lifts ? "swing" : "land")),
               swinging, phases.share(part));
    begins = nullptr;
  }
  phases.add("settle", {}, {gait.settle, gait.settle});
  return phases.take();
}

std::vector<Phase> expand_cycle(const Gait& gait, const RobotModel& robot, const Feet& feet, int stride) {
  Gait one = gait;
  one.strides = 1;
  std::vector<Phase> phases = expand(one, robot, feet, stride);
  const double stand = half_stand(gait);
  for (Phase* end : {&phases.front(), &phases.back()}) {
    end->name = fmt::format("stride {}: {}", stride, end->name);
    end->duration = {stand * gait.stride.min, stand * gait.stride.max};
  }
  return phases;
}

double middle_of_stance(const Gait& gait, Foot foot) {
  const auto& swings = gait.pattern.swings;
  const auto of_foot = [&](const std::vector<Foot>& group) { return std::ranges::find(group, foot) != group.end(); };
  const auto group = static_cast<double>(std::ranges::find_if(swings, of_foot) - swings.begin());
  return half_stand(gait) + group / static_cast<double>(swings.size()) - 0.5 * gait.duty_factor;
}

Vector3d along_arc(const Surface& surface, double heading, double length, double turn) {
  const double half = 0.5 * turn, chord = half == 0.0 ? 1.0 : std::sin(half) / half;
  return along_surface(surface, heading + half, chord * length);
}

Vector3d along_surface(const Surface& surface, double heading, double length) {
  const Vector3d flat(std::cos(heading), std::sin(heading), 0.0);
  const Vector3d climbing = flat - surface.normal.dot(flat) / surface.normal.z() * Vector3d::UnitZ();
  return length * climbing.normalized();
}

}  // namespace prowl
