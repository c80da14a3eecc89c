#pragma once

#include <vector>

namespace prowl {

/// Pairs (constraint violation theta, barrier function phi) to which a line search must not return
/// (Wächter and Biegler 2006, sec. 2.3).
class Filter {
 public:
  void reset(double largest_theta) {
    largest_theta_ = largest_theta;
    pairs_.clear();
    pairs_.reserve(100);  // most solves take fewer iterations
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
