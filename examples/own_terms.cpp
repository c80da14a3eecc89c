// Two terms of one's own in a shared library, for tasks/own_terms.toml: the hand keeps away from a ball, and goes to a
// point. Prowl differentiates both functions.
#include "prowl/task_file/own_terms.hpp"

#include <Eigen/Core>

#include "prowl/terms/own_term.hpp"

PROWL_OWN_TERMS(terms) {
  const Eigen::Vector3d ball(0.75, -0.1, 1.05), point(0.8, -0.25, 0.85);
  const prowl::Quantity hand{prowl::Quantity::Kind::position, "gripperStator"};

  terms["distance from the ball"] =
      prowl::own_term<3, 1>({hand}, {"distance"}, "m", [ball](const auto& y, auto& f) { f(0) = (y - ball).norm(); });

  terms["distance from the point"] =
      prowl::own_term<3, 3>({hand}, {"x", "y", "z"}, "m", [point](const auto& y, auto& f) { f = y - point; });
}
