#pragma once

#include <string>
#include <vector>

namespace prowl {

/// How a program keeps contacts at their footholds.
struct ContactForm {
  std::string name;
  /// True: gains of e = J a + J̇ v + kd J v + kp (p − anchor) from
  /// CollocationRule::stabilisation(). False: zero gains, the dynamics constrain accelerations
  /// only, as in the paper.
  bool stabilised = false;
  // Rows per contact in stance at all nodes except the fixed start:
  bool distance = false;      ///< 1 row: perpendicular to the surface, f_kin of Pardo et al. 2016
  double tolerance = 0.0;     ///< of `distance`, either way [m]
  bool velocity = false;      ///< 3 rows: J v = 0
  bool acceleration = false;  ///< 3 rows: J a + J̇ v = 0
};

/// All forms, the default first.
const std::vector<ContactForm>& contact_forms();

}  // namespace prowl
