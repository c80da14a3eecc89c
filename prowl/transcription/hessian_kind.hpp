#pragma once

namespace prowl {

/// Second derivatives of the Lagrangian: exact, or of the cost alone, as if constraints and recovered forces were
/// linear.
enum class HessianKind { exact, gauss_newton };

/// As in plan.json and at the command line.
inline const char* to_string(HessianKind kind) { return kind == HessianKind::exact ? "exact" : "gauss-newton"; }

}  // namespace prowl
