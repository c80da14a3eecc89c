#pragma once

#include <vector>

namespace prowl {

/// Pairs (constraint violation theta, barrier function phi) that a line search may not come back to (Wächter and
/// Biegler 2006, sec. 2.3).
class Filter {
 public:
  void reset(double largest_theta) {
    largest_theta_ = largest_theta;
    pairs_.clear();
    pairs_.reserve(100);  // more than most solves have iterations
  }
  bool accepts(double theta, double phi) const {
    if (theta > largest_theta_) return false;
    for (const Pair& pair : pairs_) {
      if (theta >= pair.theta && phi >= pair.phi) return false;
    }
    return true;
  }
  void add(double theta, double phi) { pairs_.push_back({theta, phi}); }

 private:
  struct Pair {
    double theta, phi;
  };
  double largest_theta_ = 0.0;
  std::vector<Pair> pairs_;
};

}  // namespace prowl
