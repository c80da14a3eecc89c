#pragma once

#include <string>

#include "prowl/plan_folder/plan_folder.hpp"
#include "screen/check_table.hpp"

namespace prowl {

/// "HyQ crouch: converged", mesh, size, iterations, in a few lines. `when` goes after the name: " (as planned)".
std::string plan_summary(const PlanRecord& record, const std::string& when = "");

/// "certificate: passed, grade: draft (good for simulation; certified: error < 1e-6)".
std::string verdict_line(const Certificate& certificate);

/// Verdict, grade and a table of all checks: worst value, limit, time and place; the failed ones again in one line. The
/// table fits a screen of so many columns.
std::string certificate_summary(const Certificate& certificate, std::size_t columns = kAnyWidth);

/// "local integration error (0.000184 > 0.0001), ..."; "" if none has failed.
std::string failed_checks(const Certificate& certificate);

/// The same after "failed: ", a line of its own; "" if none has.
std::string failed_checks_line(const Certificate& certificate);

/// "0.0001 m", or the number alone where there is no unit.
std::string with_unit(double value, const std::string& unit);

/// How robust the plan is; "" if that was not asked for.
std::string robust_sentence(const PlanRecord& record);

/// The gains and what they do to deviations, in a few lines.
std::string feedback_summary(const FeedbackDesign& feedback, double step);

/// All that is printed of a plan: all of the above and the advice on the mesh; of one that is certain to have no
/// solution only why, since a certificate of its initial guess says nothing.
std::string plan_report(const PlanRecord& record, const std::string& when = "", std::size_t columns = kAnyWidth);

}  // namespace prowl
