#pragma once

#include <vector>

namespace prowl {

/// Feet that swing one group after the other, for ever. Without groups the robot stands.
struct SteppingPattern {
  std::vector<std::vector<int>> groups;  ///< indices of feet, in the order in which they lift off
  double stride = 0.6;                   ///< time in which each group swings once [s]
  double duty_factor = 0.6;              ///< part of a stride in which a foot stands [-]

  bool stands() const { return groups.empty(); }
  double swing() const { return (1.0 - duty_factor) * stride; }  ///< duration of a swing [s]
};

/// Swings of each foot in absolute time. Patterns are appended at its end: a change of pattern never alters what a
/// controller has planned already. Detected contacts move landings, and in a walk lift-offs. No allocation after
/// construction but by follow().
class ContactTimeline {
 public:
  struct Swing {
    double lift = 0.0, land = 0.0;  ///< [s]
    double planned = 0.0;           ///< landing before corrections by felt contacts [s]
    double first_lift = 0.0;        ///< lift-off if no other foot is late [s]
    bool waits = false;             ///< lifts off only after the landings before it
    bool has_touched = false;       ///< its landing was felt
  };

  /// All feet stand from `start` [s] on.
  ContactTimeline(int num_feet, double start);

  /// Continues with this pattern. Throws InputError if it has other feet, or no time for swing and stance.
  void follow(const SteppingPattern& pattern);
  /// Adds the swings that begin before `until` [s], and forgets those that ended long before `now` [s].
  void extend(double now, double until);

  int num_feet() const { return static_cast<int>(feet_.size()); }
  /// The swing at time t [s], or nullptr: the foot stands. A foot stands at the moment of its landing.
  const Swing* swing(int foot, double t) const;
  /// Feet that stand at time t [s]. Bit f: foot f.
  unsigned standing(double t) const;
  /// If a foot touched the ground when it was felt last.
  bool touches(int foot) const { return of(foot).touches; }
  /// The swing that should have ended at most kLandingTime before t [s], without a touch felt since; or nullptr.
  const Swing* unfelt(int foot, double t) const;
  /// Appends lift-offs and landings between both times [s], unordered.
  void add_switches(double from, double to, std::vector<double>& switches) const;
  /// Corrects the schedule by what a foot feels at time t [s]. A foot that touches in the second half of its swing has
  /// landed. One that does not touch lands at t + `soon` [s] at the earliest: this is put off until kMostLate after the
  /// planned landing, or until the next lift-off. Then the foot counts as standing. One that has landed, but has not
  /// touched for more than kLost, has lifted off, and lands in the same way. Calls should be closer than kLost.
  void feel(int foot, bool touches, double t, double soon);
  /// The same for all feet. What is planned at t acts `delay` [s] later. In a pattern that keeps three feet on the
  /// ground, as a walk does, feet wait for late landings before they lift off.
  void feel(const std::vector<bool>& touches, double t, double delay);
  /// Time by which a landing that is scheduled for `landing` is late at time t [s]; 0 if it is not.
  double lateness(int foot, double landing, double t) const;

  static constexpr double kMostLate = 0.15;     ///< longest wait for a landing [s]
  static constexpr double kLandingTime = 0.05;  ///< after a landing that was not felt, loads stay limited [s]
  /// Longest time without a touch in which a foot still counts as standing. Walks of Go2 with kicks of 0.7 m/s fall
  /// less with 20 to 40 ms than with 50, or without. With 15, feet with little load count as lost, and loads are
  /// planned on others that slip [s].
  static constexpr double kLost = 0.03;

 private:
  struct Foot {
    double felt;                     ///< when it touched last [s]
    bool touches = true;             ///< if it did so when it was felt last
    std::vector<Swing> swings = {};  ///< in the order of time
  };
  struct Waiting {
    const Foot* foot;
    Swing* swing;
  };

  Foot& of(int foot) { return feet_[static_cast<std::size_t>(foot)]; }
  const Foot& of(int foot) const { return feet_[static_cast<std::size_t>(foot)]; }
  bool keeps_three_feet() const;
  void await_landings(double t, double soon);

  SteppingPattern pattern_;
  std::size_t next_group_ = 0;
  double next_lift_;
  std::vector<Foot> feet_;
  std::vector<Waiting> waiting_;  ///< work space: swings that have not begun, in the order of their groups
};

}  // namespace prowl
