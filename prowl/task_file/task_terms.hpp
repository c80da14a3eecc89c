#pragma once

// Reads [[term]] of a task file. Not installed: exposes toml++.
#include <optional>
#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// One use for each [[term]]. With a mesh, which has equal steps in each phase, both ends of each are at nodes.
std::vector<TermUse> read_terms(const TomlTable& root, const RobotModel& robot, const std::vector<Phase>& phases,
                                const std::optional<Mesh>& mesh);

}  // namespace prowl
