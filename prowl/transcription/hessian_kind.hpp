#pragma once

namespace prowl {

/// Second derivatives of the Lagrangian: exact, or of the cost alone, as if constraints and recovered forces were linear.
enum class HessianKind { exact, gauss_newton };

}  // namespace prowl
