#pragma once

#include <string>
#include <vector>

#include "prowl/motion/contact_schedule.hpp"

namespace prowl {

/// Contacts that no posture brings to their footholds, in the words of the task; empty if none is certain. By lengths
/// alone (ContactReach), so that what they forbid is out of reach whatever the joints and their limits:
/// - where a goal bounds the base: the distance from there to the foothold of each contact that is held at that time,
///   known or, if the optimiser chooses it, the nearest of its surface; if no contact alone is too far, the same of the
///   means of all contacts and of two, which bounds a base whose orientation is free;
/// - in every phase: two known footholds farther apart than the two legs span.
/// One line for each goal and phase: several contacts share it.
std::vector<std::string> contacts_out_of_reach(const MotionProblem& problem, const ContactSchedule& schedule);

}  // namespace prowl
