#pragma once

#include <filesystem>

#include "prowl/tracker/tracker.hpp"

namespace prowl::cli {

/// The tracker in the folder of a plan. Throws InputError.
Tracker read_tracker(const std::filesystem::path& directory);

}  // namespace prowl::cli
