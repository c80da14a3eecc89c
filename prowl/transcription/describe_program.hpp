#pragma once

#include <string>

#include "prowl/transcription/node_program.hpp"

namespace prowl {

/// Describes a row of the constraints (index in DecisionLayout): "phase 2 'swing', node 3, lh_foot,
/// friction cone, t = 0.410 s".
std::string describe_constraint(const NodeProgram& program, int row);

/// Describes a decision variable: "phase 1 'stand', node 3, velocity lf_kfe_joint, t = 0.600 s".
std::string describe_variable(const NodeProgram& program, int index);

}  // namespace prowl
