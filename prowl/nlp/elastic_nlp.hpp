#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/nlp/stored_nlp.hpp"

namespace prowl {

/// A row or a variable whose bounds may give way, at a price.
struct SoftBound {
  bool is_row = true;  ///< else a variable
  int index = 0;
  double size = 1.0;   ///< > 0: the violation that costs `price`, in the unit of the row or variable
  double price = 1.0;  ///< > 0
};

/// A program whose soft bounds may give way, so that they never make it infeasible (elastic mode of SNOPT: Gill,
/// Murray, Saunders 2005, sec. 4.3; Nocedal and Wright 2006, sec. 17.2). With slacks s >= 0, one for each finite side
/// of a soft bound:
///
///   minimise   cost_factor f(z) + sum of price s   subject to   lower <= c(z) + size (s_below - s_above) <= upper
///
/// c is a soft row, or a soft variable, which loses its own bounds. The price is on the sum, not on squares: few bounds
/// give way, and none that need not. All else is as in the inner program.
///
/// Variables: (z, s). Rows: those of the inner program, then one per soft variable. Derivatives are exact if those of
/// the inner program are.
class ElasticNlp : public StoredNlp {
 public:
  /// `inner` must outlive it. No bound may be soft twice.
  ElasticNlp(Nlp& inner, std::vector<SoftBound> soft, double cost_factor);

  /// Start from variables of the inner program, with slacks slightly larger than needed.
  Eigen::VectorXd with_slacks(const Eigen::VectorXd& z);
  Eigen::VectorXd inner(const Eigen::VectorXd& z) const { return z.head(inner_.num_variables()); }
  /// Violation of each soft bound, in the unit of the row or variable: > 0 below its lower bound, < 0 above its upper.
  Eigen::VectorXd violations(const Eigen::VectorXd& z) const;

  double cost(const Eigen::VectorXd& z) override;
  void cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) override;
  void constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) override;
  void jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) override;
  void hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override;

  std::string describe_constraint(int row) const override;
  std::string describe_variable(int index) const override;
  int use_threads(int count) override { return inner_.use_threads(count); }

 private:
  struct Slack {
    int soft;     ///< index in soft_
    int row;      ///< of this program
    double sign;  ///< +1 below, -1 above
  };

  Nlp& inner_;
  std::vector<SoftBound> soft_;
  double cost_factor_;
  std::vector<int> variables_;  ///< soft ones, in the order of their rows
  std::vector<Slack> slacks_;   ///< in the order of their variables
  Eigen::VectorXd price_;       ///< of the slacks
};

}  // namespace prowl
