#pragma once

#include <vector>

#include "prowl/model/surface.hpp"
#include "prowl/simulation/simulation_options.hpp"

namespace prowl {

/// The surfaces as they are: turned about `pivot`, world frame [m], and raised.
std::vector<Surface> with_error(std::vector<Surface> surfaces, const Eigen::Vector3d& pivot, const GroundError& error);

}  // namespace prowl
