#pragma once

#include <string>
#include <vector>

#include "prowl/online/online_run.hpp"

namespace prowl {

/// Median, 99 % and longest of times [s], in milliseconds.
struct TickTimes {
  double median = 0.0, p99 = 0.0, worst = 0.0;
  explicit TickTimes(std::vector<double> times);
};

/// A run under online control as a JSON object (docs/mpc.md).
std::string online_json(const RobotModel& robot, const OnlineOptions& options, const OnlineResult& result);

}  // namespace prowl
