#pragma once

#include <filesystem>
#include <string>

#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl {

/// What is printed of a plan that has just been made, for a screen of `columns` x 24: the motion and its largest torque
/// in two sentences, the grade with its meaning, and of the certificate all checks that fail, those that hold it at
/// grade draft, and what a robot meets first, with value, limit and the share of the limit that is used. The rest:
/// `prowl check DIRECTORY`.
std::string plan_brief(const PlanRecord& record, const std::filesystem::path& directory, std::size_t columns = 80);

}  // namespace prowl
