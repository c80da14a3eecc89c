#pragma once

#include <string>

#include "prowl/io/plan_directory.hpp"

namespace prowl {

/// The --intervals at which the local integration error would reach "draft" (if it does not) and "certified", judged
/// from this mesh: the error of an interval falls with the cube of its step. 25 % of margin, and every goal stays at a
/// node.
/// "" if it is there already, or if the solver did not converge: then the error says nothing of the mesh.
std::string mesh_advice(const PlanRecord& record);

}  // namespace prowl
