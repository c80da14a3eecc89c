#pragma once

#include <string>

#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl {

/// What would take the local integration error to "draft" (if it is not there) and "certified": --refine, or, on a mesh
/// of equal steps, the --intervals, judged from this mesh: the error of an interval falls with the cube of its step. 25
/// % of margin, and every goal stays at a node.
/// "" if it is there already, if other checks fail, or if the solver did not converge: then the error says nothing of
/// the mesh.
std::string mesh_advice(const PlanRecord& record);

}  // namespace prowl
