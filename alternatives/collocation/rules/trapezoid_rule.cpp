#include "alternatives/collocation/rules/collocation_rule.hpp"

namespace prowl {

namespace {

/// x₁ − x₀ = h/2 (ẋ₀ + ẋ₁), and v likewise. In chart coordinates; Transcription integrates
/// rotations on SO(3).
class TrapezoidRule : public CollocationRule {
 public:
  std::string name() const override { return "trapezoid"; }
  double left_share() const override { return 0.5; }
  double right_share() const override { return 0.5; }
  StabilisationOfStep stabilisation() const override { return {}; }

  void add_to(IntervalProgram& interval) const override {
    const IntervalProgram::Point left = interval.left, right = interval.right;
    interval.equal_zero(
        interval.sum({{1.0, 0, right.x}, {-1.0, 0, left.x}, {-0.5, 1, left.rate}, {-0.5, 1, right.rate}}),
        "position over the interval");
    interval.equal_zero(
        interval.sum(
            {{1.0, 0, right.v}, {-1.0, 0, left.v}, {-0.5, 1, left.acceleration}, {-0.5, 1, right.acceleration}}),
        "velocity over the interval");
  }
};

}  // namespace

std::unique_ptr<CollocationRule> trapezoid_rule() { return std::make_unique<TrapezoidRule>(); }

}  // namespace prowl
