#pragma once

#include <optional>
#include <string>
#include <vector>

namespace prowl {

/// The name of the right-hand counterpart of a left-hand part ("lf_foot" -> "rf_foot", "FL_HAA" -> "FR_HAA",
/// "leg_left_1_joint" -> "leg_right_1_joint", "left_toe_right" -> "right_toe_left", "LHipYaw" -> "RHipYaw"), if `names`
/// contains it. Empty for right-hand and central parts, so each pair is found once.
std::optional<std::string> right_counterpart(const std::string& left, const std::vector<std::string>& names);

}  // namespace prowl
