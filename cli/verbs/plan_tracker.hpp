#pragma once

#include <filesystem>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl::cli {

/// Reads the tracker of a plan folder. Throws InputError if it is missing or does not fit the
/// problem.
Tracker read_tracker(const std::filesystem::path& directory, const MotionProblem& problem);

}  // namespace prowl::cli
