#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "alternatives/collocation/rules/interval_program.hpp"
#include "prowl/transcription/node/node_functions.hpp"

namespace prowl {

/// An integration rule over one interval: variables in its middle, and equations.
class CollocationRule {
 public:
  virtual ~CollocationRule() = default;

  virtual std::string name() const = 0;
  /// Quantities with own variables in the middle of an interval.
  struct Middle {
    bool inputs = false;  ///< torques; accelerations and forces, if variables
    bool state = false;   ///< x and v
  };
  virtual Middle middle() const { return {}; }
  /// True if it evaluates accelerations within an interval, so they must be functions.
  virtual bool is_explicit() const { return false; }
  // Quadrature weights of the running cost over the step: of the left and the right node.
  virtual double left_share() const = 0;
  virtual double right_share() const = 0;
  virtual StabilisationOfStep stabilisation() const = 0;
  /// Longer steps make contact errors grow with these gains [s].
  virtual double longest_stabilised_step() const { return std::numeric_limits<double>::infinity(); }
  virtual void add_to(IntervalProgram& interval) const = 0;
};

std::unique_ptr<CollocationRule> trapezoid_rule();
std::unique_ptr<CollocationRule> hermite_simpson_rule();
std::unique_ptr<CollocationRule> separated_hermite_simpson_rule();
std::unique_ptr<CollocationRule> runge_kutta_rule();

}  // namespace prowl
