#pragma once

#include <filesystem>
#include <string>

#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl {

/// What is printed of a plan that has just been made, for a screen of 80 x 24: as plan_report() (plan_summary.hpp), of
/// the certificate only what failed, what holds it at grade draft, and what a robot meets first. All of it: `prowl
/// check DIRECTORY`.
std::string plan_brief(const PlanRecord& record, const std::filesystem::path& directory);

}  // namespace prowl
