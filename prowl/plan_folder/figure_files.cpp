#include "prowl/plan_folder/figure_files.hpp"

namespace prowl {

const std::set<std::string>& figure_file_names() {
  static const std::set<std::string> names = [] {
    std::set<std::string> all = {"limit_curves.csv"};
    for (const char* figure :
         {"torques", "contact_acceleration", "base_error", "joint_error", "gains", "torque_over_position"}) {
      for (const char* ending : {".csv", ".svg", ".png"}) all.insert(std::string(figure) + ending);
    }
    return all;
  }();
  return names;
}

}  // namespace prowl
