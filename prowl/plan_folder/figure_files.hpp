#pragma once

#include <set>
#include <string>

namespace prowl {

/// Default folder of the figures within the folder of a plan.
inline constexpr const char* kFiguresFolder = "figures";

/// Names of all files that `prowl figures` may write: for each figure .csv, .svg and .png.
const std::set<std::string>& figure_file_names();

}  // namespace prowl
