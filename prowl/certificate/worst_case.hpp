#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/trajectory/worst_moment.hpp"

namespace prowl {

/// Finds the worst moment of one check.
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

  void record(double value, double time, std::string_view where) { is_worst(value, time, where); }
  /// The same for a check of several kinds of quantities: it has the unit of its worst.
  void record(double value, double time, std::string_view where, std::string_view unit) {
    if (is_worst(value, time, where)) check_.unit = unit;
  }

  CertificateCheck check() const {
    CertificateCheck check = check_;
    check.worst = moment_.worst;
    check.time = moment_.time;
    check.where = moment_.where;
    check.passed = check.worst <= check.limit;
    return check;
  }

  /// Appends the check, unless nothing was recorded.
  void append_to(std::vector<CertificateCheck>& checks) const {
    if (!moment_.empty) checks.push_back(check());
  }

 private:
  /// Records the value, and its time if it fails.
  bool is_worst(double value, double time, std::string_view where) {
    if (!(value <= check_.limit) && (check_.failures.empty() || check_.failures.back() != time))
      check_.failures.push_back(time);
    return moment_.record(value, time, where);
  }

  CertificateCheck check_;
  WorstMoment moment_;
};

}  // namespace prowl
