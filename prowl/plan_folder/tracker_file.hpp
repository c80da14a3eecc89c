#pragma once

#include <string>

#include "prowl/tracker/tracking_plan.hpp"

namespace prowl {

/// The bytes of tracker.bin (prowl/tracker/file_format.hpp), which Tracker::read reads back to the last bit.
std::string tracker_file_bytes(const TrackingPlan& plan);

}  // namespace prowl
