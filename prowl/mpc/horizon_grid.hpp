#pragma once

#include <vector>

#include "prowl/mpc/contact_timeline.hpp"

namespace prowl {

/// Steps of a horizon, which grow from its start. Nodes are at lift-offs and landings; close ones share a node.
class HorizonGrid {
 public:
  /// `steps` >= 1 that grow by one factor from `first` to a sum of `length` [s]; equal ones if `first` is too long.
  HorizonGrid(int steps, double first, double length);

  /// Lays the grid from `start` [s] on, with nodes at the switches of the timeline.
  void lay(double start, const ContactTimeline& timeline);

  int num_steps() const { return static_cast<int>(nominal_.size()) - 1; }
  double length() const { return nominal_.back(); }                         ///< [s]
  double time(int k) const { return times_[static_cast<std::size_t>(k)]; }  ///< of the start of step k [s]
  double end() const { return times_.back(); }
  double step(int k) const { return time(k + 1) - time(k); }
  double middle(int k) const { return 0.5 * (time(k) + time(k + 1)); }
  /// The step that contains t; the first or last one beyond the ends.
  int step_at(double t) const;

 private:
  /// Between two switches, in steps of the grid without switches.
  struct Span {
    double begin, end;
    int steps;
  };
  void choose_switches(double start, const ContactTimeline& timeline);
  double index_at(double t) const;
  double time_at(double index) const;

  std::vector<double> nominal_;  ///< times of the grid without switches, from 0
  std::vector<double> times_, switches_;
  std::vector<Span> spans_;
};

}  // namespace prowl
