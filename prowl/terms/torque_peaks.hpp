#pragma once

#include <memory>

#include "prowl/terms/term.hpp"

namespace prowl {

/// (torque / limit)^4 of each joint with a torque limit [-]: as a cost the sum of eighth powers, which the largest
/// torques dominate. A smooth stand-in for the largest of all.
std::shared_ptr<const Term> torque_peaks(const RobotModel& robot);

}  // namespace prowl
