#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "prowl/terms/term.hpp"

namespace prowl {

/// Values over time: linear between the times, constant before the first and after the last.
struct TimedValues {
  Eigen::VectorXd times;   ///< ascending [s], one or more
  Eigen::MatrixXd values;  ///< one column for each time
};

/// f = entries of a quantity - their values at that time. `entries`: indices into the quantity, `rows`: their names.
/// Needs fixed durations, as all terms that read the time. Throws InputError unless the sizes fit.
std::shared_ptr<const Term> deviation(Quantity quantity, std::vector<int> entries, std::vector<std::string> rows,
                                      std::string unit, TimedValues reference);

}  // namespace prowl
