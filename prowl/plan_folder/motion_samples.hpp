#pragma once

#include <optional>
#include <vector>

#include "prowl/files/csv_table.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/tracker/tracker.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// A motion at a number of times: what every export (docs/exports.md) is made of.
struct MotionSamples {
  bool simulated = false;
  std::vector<TrajectoryPoint> points;        ///< in order of time; of a simulation without a
  std::vector<std::vector<bool>> in_contact;  ///< of each point, one a contact: as planned, or as it touched
  std::vector<Eigen::MatrixXd>
      gains;  ///< K of each point, nu x 2 nv (prowl/tracker/tracker.hpp); empty if there are none

  /// Indices of the points, one a time: of two at one time the later phase's.
  std::vector<std::size_t> one_a_time() const;
};

/// The plan at its nodes, where a switch of phases has two points at one time, or, with a rate [Hz], at multiples of
/// its period and at the end, where a switch is of the later phase. Gains if there is a tracker. Throws InputError for
/// a rate that makes no sense.
MotionSamples sample_plan(const MotionProblem& problem, const Trajectory& trajectory, const Tracker* tracker,
                          std::optional<double> rate);

/// The true motion of simulate.csv, all rows or no more than `rate` a second. `trajectory` is the plan's: it tells the
/// phases, of which the last goes on after its end. Throws InputError.
MotionSamples sample_simulation(const MotionProblem& problem, const Trajectory& trajectory, const CsvTable& simulation,
                                std::optional<double> rate);

}  // namespace prowl
