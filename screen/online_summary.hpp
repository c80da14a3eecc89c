#pragma once

#include <string>

#include "prowl/online/online_run.hpp"

namespace prowl {

/// A run under online control in words.
std::string online_summary(const RobotModel& robot, const OnlineOptions& options, const OnlineResult& result);

}  // namespace prowl
