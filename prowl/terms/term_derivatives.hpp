#pragma once

#include <Eigen/Core>
#include <string>

#include "prowl/terms/term.hpp"

namespace prowl {

/// Name of an entry of y: "position of 'lf_foot', z", "torque of 'lf_hfe_joint'".
std::string entry_name(const RobotModel& robot, const Term& term, Eigen::Index entry);

/// Compares the derivatives of a term at y with central differences. Empty if they agree to four digits or if the term
/// is not finite there; else the first entry that is wrong, with both values.
std::string wrong_derivative(const RobotModel& robot, const Term& term, const Eigen::VectorXd& y);

}  // namespace prowl
