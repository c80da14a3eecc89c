#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "prowl/trajectory/certificate.hpp"

namespace prowl {

/// Keeps the largest of many values, where and when it came; a NaN counts as larger than anything.
class WorstCase {
 public:
  WorstCase(std::string name, std::string unit, double limit)
      : WorstCase(std::move(name), std::move(unit), limit, limit) {}
  WorstCase(std::string name, std::string unit, double limit, double certified_limit) {
    check_.name = std::move(name);
    check_.unit = std::move(unit);
    check_.limit = limit;
    check_.certified_limit = certified_limit;
  }

  void record(double value, double time, std::string_view where) {
    if (!empty_ && (std::isnan(check_.worst) || value <= check_.worst)) return;
    empty_ = false;
    check_.worst = value;
    check_.time = time;
    check_.where = where;
  }

  CertificateCheck check() const {
    CertificateCheck check = check_;
    check.passed = check.worst <= check.limit;
    return check;
  }

  /// Appends the check, unless nothing was recorded.
  void append_to(std::vector<CertificateCheck>& checks) const {
    if (!empty_) checks.push_back(check());
  }

 private:
  CertificateCheck check_;
  bool empty_ = true;
};

}  // namespace prowl
