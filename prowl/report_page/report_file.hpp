#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/tracker/tracking_plan.hpp"

namespace prowl {

/// Whether the page is a file, or served while its plan is made (prowl view): then it listens to the server's events.
enum class PageState { file, solving, solved };

/// All that goes into a report.
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
  std::vector<std::string> warnings;  ///< what it shows in another way than asked for, one line each
};

/// A page that replays the plan, and the simulation if there is one (docs/report.md). Meshes are looked for as
/// package:// in robot files is. Nothing from the files becomes markup or script: it is in the page as JSON without any
/// '<'. `other` is a second plan to compare with, or null. Throws InputError for files that are wrong, FileError for a
/// template that is not one.
Report make_report(const ReportInputs& inputs, const PackageSearch& search, const ReportInputs* other = nullptr);

/// An iterate of the solver for a page that is served: its motion, charts and phases as in a report, and how far it is.
/// One line.
std::string report_iterate(const MotionProblem& problem, const Plan& iterate, const MeshIteration& at);

}  // namespace prowl
