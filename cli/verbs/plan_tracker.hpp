#pragma once

#include <filesystem>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl::cli {

/// The tracker in the folder of a plan. Throws InputError if there is none, or if it is not of this problem.
Tracker read_tracker(const std::filesystem::path& directory, const MotionProblem& problem);

}  // namespace prowl::cli
