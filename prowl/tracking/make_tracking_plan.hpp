#pragma once

#include "prowl/motion/motion_problem.hpp"
#include "prowl/tracker/tracking_plan.hpp"
#include "prowl/tracking/feedback_design.hpp"

namespace prowl {

/// Data for a tracker: reference, gains and schedule of a design; joints, contacts and torque
/// limits of the robot.
TrackingPlan make_tracking_plan(const MotionProblem& problem, const FeedbackDesign& design);

}  // namespace prowl
