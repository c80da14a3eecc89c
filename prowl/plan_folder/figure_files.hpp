#pragma once

#include <set>
#include <string>

namespace prowl {

/// Folder of the figures within the folder of a plan, unless asked for another.
inline constexpr const char* kFiguresFolder = "figures";

/// Names of all files that `prowl figures` may write: for each figure .csv, .svg and .png.
const std::set<std::string>& figure_file_names();

}  // namespace prowl
