#pragma once

#include <string>
#include <vector>

#include "prowl/motion/contact_schedule.hpp"

namespace prowl {

/// Pairs that exclude each other, one line each: a limit on the position of a link, and another one, a contact or a
/// goal of the base at the same time, farther apart than the links between them reach. Each term is named once.
std::vector<std::string> terms_out_of_reach(const MotionProblem& problem, const ContactSchedule& schedule);

}  // namespace prowl
