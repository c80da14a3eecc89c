#include "prowl/plan_folder/export_files.hpp"

namespace prowl {

const std::vector<ExportFormat>& export_formats() {
  static const std::vector<ExportFormat> formats = {
      {"csv", {"motion.csv", "gains.csv"}, false},  // of a simulation there is simulate.csv
      {"json", {"motion.json"}},
      {"npz", {"motion.npz"}},
      {"mcap", {"motion.mcap"}},
      {"joint-trajectory", {"joint_trajectory.json"}},
      {"mujoco", {"mujoco.xml", "mujoco_keyframes.xml", "mujoco_model.xml"}},
  };
  return formats;
}

std::vector<std::string> export_file_names() {
  std::vector<std::string> names;
  for (const ExportFormat& format : export_formats()) {
    for (const std::string& file : format.files) {
      names.push_back(file);
      if (format.of_simulations) names.push_back(kSimulatedPrefix + file);
    }
  }
  return names;
}

}  // namespace prowl
