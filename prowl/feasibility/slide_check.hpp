#pragma once

#include <optional>
#include <string>

#include "prowl/motion/contact_schedule.hpp"

namespace prowl {

/// The reason, in the words of the task, why no forces on the surfaces keep the robot where the task wants it; none if
/// that is not certain.
///
/// While the friction cones of all surfaces touched so far do not contain the direction up, the centre of mass
/// accelerates along a direction d by -g shortfall or more (Slide), so at time t
///
///   d . c(t) <= d . c(0) + d . ċ(0) t - g shortfall t² / 2
///
/// however the robot moves, flights included. A goal on the base position, or a contact held at the end of a phase,
/// bounds d . c(t) from below by the lengths of the links. If the two contradict each other by more than a centimetre,
/// there is no motion. The check finds a robot that starts at rest on too steep a slope and must stay for a second or
/// two, not one that leaves at once.
std::optional<std::string> why_it_slides(const MotionProblem& problem, const ContactSchedule& schedule);

}  // namespace prowl
