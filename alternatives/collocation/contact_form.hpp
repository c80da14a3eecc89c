#pragma once

#include <string>
#include <vector>

namespace prowl {

/// How a program keeps contacts that hold where they are.
struct ContactForm {
  std::string name;
  /// The gains of e = J a + J̇ v + kd J v + kp (p − anchor) are those of the rule (CollocationRule::gains()); else they
  /// are 0 and the dynamics keep accelerations only, as the paper's do.
  bool stabilised = false;
  // Rows of each held contact at the nodes, but at the start, where all is fixed.
  bool distance = false;      ///< 1 row: perpendicular to the surface, f_kin of Pardo et al. 2016
  double tolerance = 0.0;     ///< of `distance`, either way [m]
  bool velocity = false;      ///< 3 rows: J v = 0
  bool acceleration = false;  ///< 3 rows: J a + J̇ v = 0
};

/// All there are; the default first.
const std::vector<ContactForm>& contact_forms();

}  // namespace prowl
