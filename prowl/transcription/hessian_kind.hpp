#pragma once

namespace prowl {

/// Hessian of the Lagrangian: exact; of the cost with linearised constraints and forces; or the same with the curvature
/// of the friction cones besides, which is convex: without it steps along the cones can go back and forth for ever.
enum class HessianKind { exact, gauss_newton, gauss_newton_with_cones };

/// As in plan.json and at the command line, which offer the first two.
inline const char* to_string(HessianKind kind) {
  return kind == HessianKind::exact          ? "exact"
         : kind == HessianKind::gauss_newton ? "gauss-newton"
                                             : "gauss-newton with cones";
}

}  // namespace prowl
