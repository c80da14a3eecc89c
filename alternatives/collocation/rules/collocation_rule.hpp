#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "alternatives/collocation/rules/interval_program.hpp"
#include "prowl/transcription/node/node_functions.hpp"

namespace prowl {

/// How the motion gets over an interval: which variables there are in the middle, and which equations.
class CollocationRule {
 public:
  virtual ~CollocationRule() = default;

  virtual std::string name() const = 0;
  /// What has variables of its own in the middle of an interval.
  struct Middle {
    bool inputs = false;  ///< torques, and accelerations and forces where they are variables
    bool state = false;   ///< x and v
  };
  virtual Middle middle() const { return {}; }
  /// Evaluates accelerations in the course of an interval, so that they have to be functions.
  virtual bool is_explicit() const { return false; }
  // Of the step, in the integral of the running cost: of the node before an interval and of that after it.
  virtual double left_share() const = 0;
  virtual double right_share() const = 0;
  virtual StabilisationOfStep stabilisation() const = 0;
  /// With steps longer than this the gains above make errors of contacts grow [s].
  virtual double longest_stabilised_step() const { return std::numeric_limits<double>::infinity(); }
  virtual void add_to(IntervalProgram& interval) const = 0;
};

std::unique_ptr<CollocationRule> trapezoid_rule();
std::unique_ptr<CollocationRule> hermite_simpson_rule();
std::unique_ptr<CollocationRule> separated_hermite_simpson_rule();
std::unique_ptr<CollocationRule> runge_kutta_rule();

}  // namespace prowl
