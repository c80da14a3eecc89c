#pragma once

#include <string>
#include <vector>

#include "prowl/model/urdf/package_path.hpp"
#include "prowl/online/online_run.hpp"
#include "prowl/report_page/page_template.hpp"

namespace prowl {

/// Inputs of the page of `prowl mpc`: a run, or what is known of it before its end.
struct OnlinePageInputs {
  const RobotModel& robot;
  const OnlineOptions& options;
  const OnlineResult& result;  ///< with at least one sample
  std::string template_html;   ///< the page without data, built from report/
  PageState state = PageState::file;
};

/// A page that replays a run, with commands, kicks and computing times; while the run goes on it takes commands. Meshes
/// are searched for like package:// paths of robot files. `warnings`: replaced content, one line each. Throws FileError
/// for an invalid template.
std::string online_page(const OnlinePageInputs& inputs, const PackageSearch& search,
                        std::vector<std::string>& warnings);

/// One moment of a run that goes on, for its page. JSON on one line.
std::string online_event(const RobotModel& robot, const OnlineSample& sample);

}  // namespace prowl
