#include "prowl/terms/torque_peaks.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace prowl {

namespace {

class TorquePeaks : public Term {
 public:
  TorquePeaks(const std::vector<std::string>& joints, Eigen::ArrayXd per_limit)
      : Term({{Quantity::Kind::torques}}, joints, "-"), per_limit_(std::move(per_limit)) {}

  void value(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> f) const override {
    f = (y.array() * per_limit_).square().square();
  }
  void jacobian(const Eigen::VectorXd& y, Eigen::Ref<Eigen::MatrixXd> f_y) const override {
    f_y.diagonal() = 4.0 * (y.array() * per_limit_).cube() * per_limit_;
  }
  void hessian(const Eigen::VectorXd& y, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::MatrixXd> f_yy) const override {
    f_yy.diagonal() = 12.0 * multipliers.array() * (y.array() * per_limit_).square() * per_limit_.square();
  }

 private:
  Eigen::ArrayXd per_limit_;  ///< 1 / limit; 0 without one
};

}  // namespace

std::shared_ptr<const Term> torque_peaks(const RobotModel& robot) {
  Eigen::ArrayXd per_limit(robot.nu());
  for (int joint = 0; joint < robot.nu(); ++joint) {
    const double limit = robot.torque_limit()(joint);
    per_limit(joint) = std::isfinite(limit) && limit > 0.0 ? 1.0 / limit : 0.0;
  }
  return std::make_shared<TorquePeaks>(robot.joint_names(), per_limit);
}

}  // namespace prowl
