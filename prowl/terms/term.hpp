#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "prowl/terms/quantity.hpp"

namespace prowl {

/// A function f(y) of what the robot does at one moment, for costs and limits of the user's own.
///
/// y has the entries of the quantities that the term reads, one after the other. Derivatives are in y alone: Prowl
/// applies the chain rule through the robot's kinematics. The planner's and the certificate's y come from different
/// code. Threads share a term: its functions must be free of side effects.
class Term {
 public:
  virtual ~Term() = default;

  const std::vector<Quantity>& reads() const { return reads_; }
  const std::vector<std::string>& rows() const { return rows_; }  ///< names of the entries of f: "x"
  const std::string& unit() const { return unit_; }               ///< of all entries of f: "m", "rad"; "-" if none
  /// Scale of f in its unit, of which the certificate tolerates a thousandth; 0: both follow from the unit
  /// (term_use.hpp).
  double size() const { return size_; }
  int num_rows() const { return static_cast<int>(rows_.size()); }

  /// One entry for each row; all are zero before.
  virtual void value(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> f) const = 0;
  /// One row for each entry of f, one column for each of y; all entries are zero before.
  virtual void jacobian(const Eigen::VectorXd& y, Eigen::Ref<Eigen::MatrixXd> f_y) const = 0;
  /// Symmetric second derivatives of multipliers . f in y; all entries are zero before.
  virtual void hessian(const Eigen::VectorXd& y, const Eigen::VectorXd& multipliers,
                       Eigen::Ref<Eigen::MatrixXd> f_yy) const = 0;

 protected:
  Term(std::vector<Quantity> reads, std::vector<std::string> rows, std::string unit, double size = 0.0)
      : reads_(std::move(reads)), rows_(std::move(rows)), unit_(std::move(unit)), size_(size) {}
  Term(const Term&) = default;
  Term& operator=(const Term&) = default;

 private:
  std::vector<Quantity> reads_;
  std::vector<std::string> rows_;
  std::string unit_;
  double size_;
};

/// Number of entries of y.
inline int size_of(const std::vector<Quantity>& reads, const RobotModel& robot) {
  int size = 0;
  for (const Quantity& quantity : reads) size += size_of(quantity.kind, robot);
  return size;
}

}  // namespace prowl
