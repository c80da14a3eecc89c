#include "alternatives/collocation/rules/collocation_rule.hpp"

namespace prowl {

namespace {

/// Simpson's rule over a cubic through both ends. Its middle is a function of them (compressed) or
/// has its own variables (separated). Hargraves, Paris 1987; Betts 2010, sec. 4.5 and 4.10.4:
///
///   x_m = (x₀ + x₁)/2 + h/8 (ẋ₀ − ẋ₁),   x₁ − x₀ = h/6 (ẋ₀ + 4 ẋ_m + ẋ₁),   v with its rate likewise
class HermiteSimpsonRule : public CollocationRule {
 public:
  explicit HermiteSimpsonRule(bool separated) : separated_(separated) {}

  std::string name() const override { return separated_ ? "hermite-simpson-separated" : "hermite-simpson"; }
  Middle middle() const override { return {.inputs = true, .state = separated_}; }
  double left_share() const override { return 1.0 / 6.0; }
  double right_share() const override { return 1.0 / 6.0; }
  /// Double root at −2/h: the rule reduces an error by (1 − 1 + 1/3)/(1 + 1 + 1/3) = 1/7.
  StabilisationOfStep stabilisation() const override { return {.rate = 4.0, .stiffness = 4.0}; }

  void add_to(IntervalProgram& interval) const override {
    using Vector = IntervalProgram::Vector;
    const IntervalProgram::Point left = interval.left, right = interval.right;
    const auto in_the_middle = [&](Vector y0, Vector y1, Vector d0, Vector d1) {
      return interval.sum({{0.5, 0, y0}, {0.5, 0, y1}, {0.125, 1, d0}, {-0.125, 1, d1}});
    };
    const Vector x = in_the_middle(left.x, right.x, left.rate, right.rate);
    const Vector v = in_the_middle(left.v, right.v, left.acceleration, right.acceleration);
    IntervalProgram::Point middle = interval.middle;
    if (separated_) {
      interval.equal_zero(interval.sum({{1.0, 0, middle.x}, {-1.0, 0, x}}), "position in the middle");
      interval.equal_zero(interval.sum({{1.0, 0, middle.v}, {-1.0, 0, v}}), "velocity in the middle");
    } else {
      middle.x = x;
      middle.v = v;
    }
    middle = interval.evaluated(middle, 4.0 / 6.0, true);
    const auto simpson = [&](Vector y0, Vector y1, Vector d0, Vector d, Vector d1) {
      return interval.sum({{1.0, 0, y1}, {-1.0, 0, y0}, {-1.0 / 6.0, 1, d0}, {-4.0 / 6.0, 1, d}, {-1.0 / 6.0, 1, d1}});
    };
    interval.equal_zero(simpson(left.x, right.x, left.rate, middle.rate, right.rate), "position over the interval");
    interval.equal_zero(simpson(left.v, right.v, left.acceleration, middle.acceleration, right.acceleration),
                        "velocity over the interval");
  }

 private:
  bool separated_;
};

}  // namespace

std::unique_ptr<CollocationRule> hermite_simpson_rule() { return std::make_unique<HermiteSimpsonRule>(false); }
std::unique_ptr<CollocationRule> separated_hermite_simpson_rule() { return std::make_unique<HermiteSimpsonRule>(true); }

}  // namespace prowl
