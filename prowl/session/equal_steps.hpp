#pragma once

#include "prowl/mesh/mesh.hpp"
#include "prowl/task_file/task.hpp"

namespace prowl {

/// The first mesh of a task, each interval in as many equal ones as the trapezoid needs to meet grade draft. For
/// comparisons of formulations on one mesh. Solves a few meshes; throws InputError if none of them converges.
Mesh equal_steps_for_draft(const Task& task);

}  // namespace prowl
