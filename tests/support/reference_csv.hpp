#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace prowl::test {

/// A reference of HyQ with one row for each time; the base's x counts the rows from 0, all joints are zero.
inline std::string reference_csv(const std::vector<double>& times) {
  std::string text = "time_s,base_px_m,base_py_m,base_pz_m,base_qx,base_qy,base_qz,base_qw";
  for (const char* leg : {"lf", "lh", "rf", "rh"}) {
    for (const char* joint : {"haa", "hfe", "kfe"}) text += fmt::format(",q_{}_{}_joint_rad", leg, joint);
  }
  text += "\n";
  for (std::size_t k = 0; k < times.size(); ++k) {
    text += fmt::format("{},{},0,0.6,0,0,0,1", times[k], k);
    for (int joint = 0; joint < 12; ++joint) text += ",0";
    text += "\n";
  }
  return text;
}

}  // namespace prowl::test
