#pragma once

#include <string>
#include <vector>

#include "prowl/motion/contact_schedule.hpp"

namespace prowl {

/// Contacts that no posture brings to their footholds, in the words of the task; empty if none is certain. Uses lengths
/// (ContactReach), and limits of joints where nothing else is free:
/// - if a goal bounds the base: its distance to the foothold of each contact held at that time, known or, if the
///   optimiser chooses it, the nearest of its surface. If no contact alone is too far, the means of all contacts and of
///   each pair are tested, which works for any base orientation;
/// - in every phase: two known footholds farther apart than the two legs span.
/// - if a goal fixes the base: each known foothold by itself, over all joint positions (least_distance_within_limits).
/// One line per goal and phase; several contacts share it.
std::vector<std::string> contacts_out_of_reach(const MotionProblem& problem, const ContactSchedule& schedule);

}  // namespace prowl
