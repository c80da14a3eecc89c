#pragma once

#include <filesystem>

#include "prowl/report_page/report_file.hpp"

namespace prowl::cli {

/// Plan, page and whatever else of the plan's folder goes into its report: simulation, gains. "" for a plan without
/// one.
ReportInputs report_inputs(const PlanRecord& plan, const std::filesystem::path& directory);

/// The report, of two plans if there is an `other`; its warnings are told on stderr, too.
Report report_page(const ReportInputs& inputs, const PackageSearch& search, const ReportInputs* other = nullptr);

}  // namespace prowl::cli
