#pragma once

namespace prowl {

/// Hessian of the Lagrangian: exact, or of the cost with linearised constraints and forces.
enum class HessianKind { exact, gauss_newton };

/// As in plan.json and at the command line.
inline const char* to_string(HessianKind kind) { return kind == HessianKind::exact ? "exact" : "gauss-newton"; }

}  // namespace prowl
