#pragma once

#include <string>
#include <vector>

namespace prowl {

/// Default folder of the exports within the folder of a plan.
inline constexpr const char* kExportsFolder = "exports";

/// One format of `prowl export` and its files; see docs/exports.md.
struct ExportFormat {
  std::string name;                ///< as for --format
  std::vector<std::string> files;  ///< of a plan; those of a simulation begin with kSimulatedPrefix
  bool of_simulations = true;      ///< true if simulations have it, too
};

inline constexpr const char* kSimulatedPrefix = "simulated_";

const std::vector<ExportFormat>& export_formats();

/// Names of all files that `prowl export` may write.
std::vector<std::string> export_file_names();

}  // namespace prowl
