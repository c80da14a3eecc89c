#pragma once

// The parts of a report as JSON (docs/report.md). Times are in seconds, placements in the world as
// x y z [m] and a unit quaternion x y z w; arrays of numbers are base64 of little-endian 32-bit
// floats. Not installed: exposes nlohmann::json.
#include <nlohmann/json.hpp>

#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/robust/tube.hpp"
#include "prowl/tracker/tracking_plan.hpp"

namespace prowl {

/// "meshes", "visuals", "bodies", "contacts", "surfaces". A mesh that cannot be read is replaced by a box of its body's
/// inertia, with a line in `warnings`.
nlohmann::ordered_json report_scene(const RobotModel& robot, const std::vector<Surface>& surfaces,
                                    const PackageSearch& search, std::vector<std::string>& warnings);

/// "time", "placements" (of every body at every time), "forces" (of every contact, world frame [N]) and "mass_centre"
/// (of the whole robot, world frame [m]).
nlohmann::ordered_json report_motion_json(const RobotModel& robot, const std::vector<TrajectoryPoint>& points);

/// Array of tabs; a tab contains charts, a chart series over the time of "plan" or "simulation". `tube`: of a robust
/// plan, else null.
nlohmann::ordered_json report_charts(const MotionProblem& problem, const std::vector<TrajectoryPoint>& plan,
                                     const std::vector<TrajectoryPoint>& simulation, const Tube* tube = nullptr);

/// K(t) at samples about `step` [s] apart: "time" and "values", nu x 2 nv each, row by row.
nlohmann::ordered_json report_gains(const TrackingPlan& plan, double step);

}  // namespace prowl
