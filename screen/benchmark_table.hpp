#pragma once

#include <string>
#include <vector>

#include "prowl/online/benchmark.hpp"

namespace prowl {

/// The rows that have runs as a table in Markdown. `runs`: JSON array of online_json() objects with the name of their
/// row.
std::string benchmark_table(const RobotModel& robot, const std::vector<BenchmarkRow>& rows, const std::string& runs);

}  // namespace prowl
