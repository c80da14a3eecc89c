#pragma once

#include "alternatives/formulation.hpp"

// All programs but the planner's own are in libprowl_formulations.so, which a program loads when it asks for one: the
// command and the Python module are built, and start, without them.
namespace prowl {

/// The library, and its function. It checks nothing; the caller owns the result.
constexpr const char* kFormulationLibrary = "libprowl_formulations.so";
constexpr const char* kMakeFormulation = "prowl_make_formulation";
using MakeFormulation = MotionNlp* (*)(const Formulation&, const DiscreteProblem&, const Trajectory& guess);

}  // namespace prowl
