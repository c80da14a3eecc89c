#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/terms/autodiff_scalar.hpp"
#include "prowl/terms/term.hpp"

namespace prowl {

/// A term from a function of any scalar, with derivatives by Eigen's AutoDiffScalar: see own_term().
template <int Entries, int Rows, class Function>
class AutodiffTerm : public Term {
 public:
  AutodiffTerm(std::vector<Quantity> reads, std::vector<std::string> rows, std::string unit, Function function,
               double size)
      : Term(std::move(reads), std::move(rows), std::move(unit), size), function_(std::move(function)) {
    if (num_rows() == Rows) return;
    throw InputError("own_term: " + std::to_string(num_rows()) + " names of rows are not allowed; need " +
                     std::to_string(Rows));
  }

  void value(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> f) const override {
    Eigen::Matrix<double, Rows, 1> result = Eigen::Matrix<double, Rows, 1>::Zero();
    function_(entries(y), result);
    f = result;
  }
  void jacobian(const Eigen::VectorXd& y, Eigen::Ref<Eigen::MatrixXd> f_y) const override {
    using Scalar = FirstDerivatives<Entries>;
    const Eigen::Matrix<double, Entries, 1> at = entries(y);
    Eigen::Matrix<Scalar, Entries, 1> variables;
    for (int i = 0; i < Entries; ++i) variables(i) = Scalar(at(i), Entries, i);
    Eigen::Matrix<Scalar, Rows, 1> result;
    for (int row = 0; row < Rows; ++row) result(row) = 0.0 * variables(0);
    function_(variables, result);
    for (int row = 0; row < Rows; ++row) f_y.row(row) = result(row).derivatives().transpose();
  }
  void hessian(const Eigen::VectorXd& y, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::MatrixXd> f_yy) const override {
    const auto variables = second_order_variables<Entries>(entries(y));
    Eigen::Matrix<SecondOrder<Entries>, Rows, 1> result;
    for (int row = 0; row < Rows; ++row) result(row) = 0.0 * variables(0);
    function_(variables, result);
    for (int row = 0; row < Rows; ++row) {
      for (int i = 0; i < Entries; ++i) {
        f_yy.row(i) += multipliers(row) * result(row).derivatives()(i).derivatives().transpose();
      }
    }
  }

 private:
  static Eigen::Matrix<double, Entries, 1> entries(const Eigen::VectorXd& y) {
    if (y.size() == Entries) return y;
    throw InputError("own_term: the quantities have " + std::to_string(y.size()) + " entries, and the function " +
                     std::to_string(Entries));
  }

  Function function_;
};

/// A term of one's own from its value alone: its derivatives are automatic. `Entries`: length of y; `Rows`: of f.
/// function(const Eigen::Matrix<S, Entries, 1>& y, Eigen::Matrix<S, Rows, 1>& f) sets f, zero before, for any scalar S:
/// double, or those of autodiff_scalar.hpp.
///
///   own_term<3, 1>({{Quantity::Kind::position, "lf_foot"}}, {"distance"}, "m",
///                  [center](const auto& y, auto& f) { f(0) = (y - center).norm(); });
///
/// `size`: Term::size(). Throws InputError if the number of names is not Rows.
template <int Entries, int Rows, class Function>
std::shared_ptr<const Term> own_term(std::vector<Quantity> reads, std::vector<std::string> rows, std::string unit,
                                     Function function, double size = 0.0) {
  return std::make_shared<AutodiffTerm<Entries, Rows, Function>>(std::move(reads), std::move(rows), std::move(unit),
                                                                 std::move(function), size);
}

}  // namespace prowl
