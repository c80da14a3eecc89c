#pragma once

#include <cstdint>

#include "prowl/model/urdf/package_path.hpp"
#include "prowl/online/online_run.hpp"

namespace prowl::cli {

/// Runs in real time and serves a page that shows the robot and takes commands and kicks. After the end,
/// if it is not by Ctrl-C, the page shows the whole run, until Ctrl-C.
OnlineResult view_online(const RobotModel& robot, const OnlineOptions& options, const PackageSearch& search,
                         std::uint16_t port);

}  // namespace prowl::cli
