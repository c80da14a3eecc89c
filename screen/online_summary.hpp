#pragma once

#include <string>

#include "prowl/online/online_run.hpp"

namespace prowl {

/// A run under online control in words, and as a JSON object.
std::string online_summary(const RobotModel& robot, const OnlineOptions& options, const OnlineResult& result);
std::string online_json(const RobotModel& robot, const OnlineOptions& options, const OnlineResult& result);

}  // namespace prowl
