#include "prowl/terms/term_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = Quantity::Kind;

const char* kind_name(Kind kind) {
  switch (kind) {
    case Kind::position: return "position";
    case Kind::orientation: return "orientation";
    case Kind::velocity: return "velocity";
    case Kind::orientation_rate: return "rate of the orientation";
    case Kind::center_of_mass: return "centre of mass";
    case Kind::center_of_mass_velocity: return "velocity of the centre of mass";
    case Kind::angular_momentum: return "angular momentum";
    case Kind::joints: return "position";
    case Kind::joint_rates: return "rate";
    case Kind::torques: return "torque";
    case Kind::force: return "force";
    case Kind::time: return "time";
  }
  return "";
}

/// One function of y and its derivative, as the term gives it.
struct Compared {
  std::string (*describe)(const RobotModel&, const Term&, Index row, Index column);
  MatrixXd exact, by_differences;
  double rounding;  ///< of a difference
};

constexpr double kStep = 1e-6;  // of an entry of y, or of one if that is larger

double step_of(double entry) { return kStep * std::max(1.0, std::abs(entry)); }

template <class Function>
MatrixXd differences(const VectorXd& y, Index rows, const Function& function) {
  MatrixXd result(rows, y.size());
  for (Index i = 0; i < y.size(); ++i) {
    const VectorXd step = step_of(y(i)) * VectorXd::Unit(y.size(), i);
    result.col(i) = (function(y + step) - function(y - step)) / (2.0 * step(i));
  }
  return result;
}

std::string first_wrong(const RobotModel& robot, const Term& term, const Compared& compared) {
  constexpr double kRelative = 1e-4;
  const auto& differences = compared.by_differences.array();
  const double scale = kRelative * kRelative * differences.isFinite().select(differences.abs(), 0.0).maxCoeff();
  for (Index row = 0; row < compared.exact.rows(); ++row) {
    for (Index column = 0; column < compared.exact.cols(); ++column) {
      const double exact = compared.exact(row, column), by_differences = compared.by_differences(row, column);
      const double allowed = kRelative * std::abs(by_differences) + scale + compared.rounding;
      if (std::abs(exact - by_differences) <= allowed || !std::isfinite(by_differences)) continue;
      return fmt::format("{} is {:.6g}; finite differences give {:.6g}", compared.describe(robot, term, row, column),
                         exact, by_differences);
    }
  }
  return {};
}

}  // namespace

std::string entry_name(const RobotModel& robot, const Term& term, Index entry) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (const Quantity& quantity : term.reads()) {
    const int size = size_of(quantity.kind, robot);
    if (entry >= size) {
      entry -= size;
      continue;
    }
    const char* const kind = kind_name(quantity.kind);
    if (is_of_joints(quantity.kind)) return fmt::format("{} of '{}'", kind, robot.joint_names()[entry]);
    if (size == 9) {
      return fmt::format("{} of '{}', axis {}, {}", kind, quantity.name, kAxes[entry / 3], kAxes[entry % 3]);
    }
    if (size == 1) return kind;
    if (quantity.name.empty()) return fmt::format("{}, {}", kind, kAxes[entry]);
    return fmt::format("{} of '{}', {}", kind, quantity.name, kAxes[entry]);
  }
  return "";
}

std::string wrong_derivative(const RobotModel& robot, const Term& term, const VectorXd& y) {
  const int rows = term.num_rows();
  const auto value = [&](const VectorXd& at) {
    VectorXd f = VectorXd::Zero(rows);
    term.value(at, f);
    return f;
  };
  const auto jacobian = [&](const VectorXd& at) {
    MatrixXd f_y = MatrixXd::Zero(rows, y.size());
    term.jacobian(at, f_y);
    return f_y;
  };
  if (!value(y).allFinite()) return {};
  const double rounding = 10.0 * std::numeric_limits<double>::epsilon() / kStep;
  const MatrixXd f_y = jacobian(y);
  const std::string first =
      first_wrong(robot, term,
                  {[](const RobotModel& model, const Term& of, Index row, Index column) {
                     return fmt::format("the derivative of '{}' with respect to the {}", of.rows()[row],
                                        entry_name(model, of, column));
                   },
                   f_y, differences(y, rows, value), rounding * (1.0 + value(y).cwiseAbs().maxCoeff())});
  if (!first.empty()) return first;
  const VectorXd multipliers = VectorXd::LinSpaced(rows, 1.0, 2.0);  // different ones, so that no sum cancels
  MatrixXd f_yy = MatrixXd::Zero(y.size(), y.size());
  term.hessian(y, multipliers, f_yy);
  return first_wrong(
      robot, term,
      {[](const RobotModel& model, const Term& of, Index row, Index column) {
         return fmt::format(
             "the second derivative of all rows, with multipliers from 1 to 2, with respect to the {} and the {}",
             entry_name(model, of, row), entry_name(model, of, column));
       },
       f_yy,
       differences(y, y.size(), [&](const VectorXd& at) -> VectorXd { return jacobian(at).transpose() * multipliers; }),
       rounding * (1.0 + 2.0 * f_y.cwiseAbs().maxCoeff())});
}

}  // namespace prowl
