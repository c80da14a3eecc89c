#include "alternatives/collocation/rules/collocation_rule.hpp"

namespace prowl {

namespace {

/// Multiple shooting by the classical explicit Runge-Kutta rule of order four, with linear torques;
/// integrates the running cost, too.
class RungeKuttaRule : public CollocationRule {
 public:
  std::string name() const override { return "rk4"; }
  bool is_explicit() const override { return true; }
  double left_share() const override { return 1.0 / 6.0; }
  double right_share() const override { return 0.0; }
  /// Double root at −10/s for any step. Gains proportional to 1/h would lower the order: stages
  /// violate contacts by O(h²), and 2/h times that in an acceleration leaves order one in v (seen
  /// in a test).
  StabilisationOfStep stabilisation() const override { return {0.0, 0.0, 20.0, 100.0}; }
  double longest_stabilised_step() const override { return 0.278; }  // stability limit −2.78/h

  void add_to(IntervalProgram& interval) const override {
    using Point = IntervalProgram::Point;
    using Vector = IntervalProgram::Vector;
    const Point left = interval.left;  // k1
    const Vector halfway = interval.sum({{0.5, 0, left.tau}, {0.5, 0, interval.right.tau}});
    // State after a part of the step from the left end, with the rates of `from`.
    const auto on = [&](double part, const Point& from, Vector tau) {
      return Point{.x = interval.sum({{1.0, 0, left.x}, {part, 1, from.rate}}),
                   .v = interval.sum({{1.0, 0, left.v}, {part, 1, from.acceleration}}),
                   .rate = {},
                   .acceleration = {},
                   .tau = tau,
                   .w = left.w};
    };
    const Point k2 = interval.evaluated(on(0.5, left, halfway), 2.0 / 6.0, false);
    const Point k3 = interval.evaluated(on(0.5, k2, halfway), 2.0 / 6.0, false);
    const Point k4 = interval.evaluated(on(1.0, k3, interval.right.tau), 1.0 / 6.0, false);
    const auto defect = [&](Vector y0, Vector y1, Vector d1, Vector d2, Vector d3, Vector d4) {
      return interval.sum({{1.0, 0, y1},
                           {-1.0, 0, y0},
                           {-1.0 / 6.0, 1, d1},
                           {-2.0 / 6.0, 1, d2},
                           {-2.0 / 6.0, 1, d3},
                           {-1.0 / 6.0, 1, d4}});
    };
    interval.equal_zero(defect(left.x, interval.right.x, left.rate, k2.rate, k3.rate, k4.rate),
                        "position over the interval");
    interval.equal_zero(
        defect(left.v, interval.right.v, left.acceleration, k2.acceleration, k3.acceleration, k4.acceleration),
        "velocity over the interval");
  }
};

}  // namespace

std::unique_ptr<CollocationRule> runge_kutta_rule() { return std::make_unique<RungeKuttaRule>(); }

}  // namespace prowl
