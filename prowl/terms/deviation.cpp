#include "prowl/terms/deviation.hpp"

#include <algorithm>
#include <utility>

#include "prowl/error.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

/// y: the quantity, then the time.
class Deviation : public Term {
 public:
  Deviation(Quantity quantity, std::vector<int> entries, std::vector<std::string> rows, std::string unit,
            TimedValues reference)
      : Term({std::move(quantity), {.kind = Quantity::Kind::time}}, std::move(rows), std::move(unit)),
        entries_(std::move(entries)),
        reference_(std::move(reference)) {}

  void value(const VectorXd& y, Ref<VectorXd> f) const override {
    const double time = y(y.size() - 1);
    const Index k = piece(time);
    f = -reference_.values.col(k);
    if (k + 1 < reference_.times.size() && time > reference_.times(k)) f -= (time - reference_.times(k)) * slope(k);
    for (std::size_t row = 0; row < entries_.size(); ++row) f(static_cast<Index>(row)) += y(entries_[row]);
  }
  void jacobian(const VectorXd& y, Ref<MatrixXd> f_y) const override {
    f_y.setZero();
    for (std::size_t row = 0; row < entries_.size(); ++row) f_y(static_cast<Index>(row), entries_[row]) = 1.0;
    const double time = y(y.size() - 1);
    const Index k = piece(time);
    if (k + 1 < reference_.times.size() && time > reference_.times(k)) f_y.rightCols<1>() = -slope(k);
  }
  void hessian(const VectorXd& /*y*/, const VectorXd& /*multipliers*/, Ref<MatrixXd> f_yy) const override {
    f_yy.setZero();
  }

 private:
  /// Index of the last time that is not after this one; 0 before the first.
  Index piece(double time) const {
    const auto after = std::ranges::upper_bound(reference_.times, time);
    return std::max<Index>(after - reference_.times.begin() - 1, 0);
  }
  VectorXd slope(Index k) const {
    return (reference_.values.col(k + 1) - reference_.values.col(k)) / (reference_.times(k + 1) - reference_.times(k));
  }

  std::vector<int> entries_;
  TimedValues reference_;
};

}  // namespace

std::shared_ptr<const Term> deviation(Quantity quantity, std::vector<int> entries, std::vector<std::string> rows,
                                      std::string unit, TimedValues reference) {
  const auto size = std::ssize(entries);
  if (size == 0 || std::ssize(rows) != size || reference.values.rows() != size || reference.times.size() == 0 ||
      reference.values.cols() != reference.times.size()) {
    throw InputError("deviation: the sizes of entries, rows, times and values do not fit");
  }
  if (!reference.times.allFinite() || !reference.values.allFinite() ||
      std::ranges::adjacent_find(reference.times, std::greater_equal<>()) != reference.times.end()) {
    throw InputError("deviation: the reference is not finite, or its times do not ascend");
  }
  return std::make_shared<Deviation>(std::move(quantity), std::move(entries), std::move(rows), std::move(unit),
                                     std::move(reference));
}

}  // namespace prowl
