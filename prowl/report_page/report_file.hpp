#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/report_page/page_template.hpp"
#include "prowl/tracker/tracking_plan.hpp"

namespace prowl {

/// Inputs of a report.
struct ReportInputs {
  const PlanRecord& plan;
  std::string directory;                           ///< of the plan, as the user named it
  std::optional<SourceText> simulation = {};       ///< simulate.csv
  std::optional<SourceText> simulation_json = {};  ///< simulate.json
  std::optional<TrackingPlan> tracking = {};       ///< tracker.bin
  std::string template_html;                       ///< the page without data, built from report/
  PageState state = PageState::file;
};

struct Report {
  std::string html;                   ///< one file that needs no other
  std::vector<std::string> warnings;  ///< replaced content, e.g. an unreadable mesh; one line each
};

/// A page that replays the plan and, if present, the simulation (docs/report.md). Meshes are
/// searched for like package:// paths of robot files. The page contains the inputs as JSON without
/// '<', so they cannot become markup or script. `other`: a second plan to compare, or null. Throws
/// InputError for invalid inputs, FileError for an invalid template.
Report make_report(const ReportInputs& inputs, const PackageSearch& search, const ReportInputs* other = nullptr);

/// One solver iterate for a served page: motion, charts and phases as in a report, and progress.
/// JSON on one line.
std::string report_iterate(const MotionProblem& problem, const Plan& iterate, const MeshIteration& at);

}  // namespace prowl
