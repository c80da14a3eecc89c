#include "prowl/motion/margins.hpp"

#include <algorithm>

namespace prowl {

Eigen::VectorXd margin_at(const Eigen::MatrixXd& margins, double fraction) {
  const auto last = static_cast<double>(margins.cols() - 1);
  const double position = std::clamp(fraction, 0.0, 1.0) * last;
  const auto before = static_cast<Eigen::Index>(position);
  const Eigen::Index after = std::min(before + 1, margins.cols() - 1);
  const double share = position - static_cast<double>(before);
  return (1.0 - share) * margins.col(before) + share * margins.col(after);
}

}  // namespace prowl
