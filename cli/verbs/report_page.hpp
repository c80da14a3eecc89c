#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "prowl/report_page/report_file.hpp"

namespace prowl::cli {

/// A page that the build made of report/, without its data: "report", "online". Throws FileError if it is missing.
std::string page_without_data(const std::string& name);

/// Prints what a page lacks on stderr.
void print_warnings(const std::vector<std::string>& warnings);

/// Inputs of the report: plan, page, and simulation and gains from `directory`; "": plan without a
/// folder.
ReportInputs report_inputs(const PlanRecord& plan, const std::filesystem::path& directory);

/// Makes the report, with `other` of two plans; prints its warnings on stderr.
Report report_page(const ReportInputs& inputs, const PackageSearch& search, const ReportInputs* other = nullptr);

}  // namespace prowl::cli
