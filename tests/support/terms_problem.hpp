#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "prowl/model/robot_frame.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/terms/frame_terms.hpp"
#include "prowl/terms/selected_entries.hpp"
#include "prowl/terms/torque_peaks.hpp"

/// Every kind of term, as a limit and as a cost, for tests of derivatives.
namespace prowl::test {

inline TermUse limit_on(std::string name, std::shared_ptr<const Term> term, double lower, double upper) {
  const int rows = term->num_rows();
  return {.name = std::move(name),
          .term = std::move(term),
          .lower = Eigen::VectorXd::Constant(rows, lower),
          .upper = Eigen::VectorXd::Constant(rows, upper)};
}

inline TermUse cost_on(std::string name, std::shared_ptr<const Term> term, double weight, double reference) {
  const int rows = term->num_rows();
  return {.name = std::move(name),
          .term = std::move(term),
          .reference = Eigen::VectorXd::Constant(rows, reference),
          .weight = weight * (Eigen::MatrixXd::Constant(rows, rows, 0.3) +
                              Eigen::MatrixXd(Eigen::VectorXd::LinSpaced(rows, 1.0, 2.0).asDiagonal()))};
}

/// A user's: torque times rate of the first joint, and the height that its contact's force holds.
inline std::shared_ptr<const Term> power_of_first_joint(const RobotModel& robot) {
  class Power : public Term {
   public:
    explicit Power(const RobotModel& robot)
        : Term({{.kind = Quantity::Kind::torques},
                {.kind = Quantity::Kind::joint_rates},
                {.kind = Quantity::Kind::force, .name = robot.contacts()[0].name},
                {.kind = Quantity::Kind::position, .name = kBaseFrame}},
               {"power"}, "W"),
          nu_(robot.nu()) {}
    void value(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> f) const override {
      f(0) = y(0) * y(nu_) + 0.01 * y(2 * nu_ + 2) * y(2 * nu_ + 5);
    }
    void jacobian(const Eigen::VectorXd& y, Eigen::Ref<Eigen::MatrixXd> f_y) const override {
      f_y(0, 0) = y(nu_);
      f_y(0, nu_) = y(0);
      f_y(0, 2 * nu_ + 2) = 0.01 * y(2 * nu_ + 5);
      f_y(0, 2 * nu_ + 5) = 0.01 * y(2 * nu_ + 2);
    }
    void hessian(const Eigen::VectorXd& /*y*/, const Eigen::VectorXd& multipliers,
                 Eigen::Ref<Eigen::MatrixXd> f_yy) const override {
      f_yy(0, nu_) = f_yy(nu_, 0) = multipliers(0);
      f_yy(2 * nu_ + 2, 2 * nu_ + 5) = f_yy(2 * nu_ + 5, 2 * nu_ + 2) = 0.01 * multipliers(0);
    }

   private:
    Eigen::Index nu_;
  };
  return std::make_shared<Power>(robot);
}

inline TermUse over(TermUse use, PhaseFraction from, PhaseFraction to) {
  use.from = from;
  use.to = to;
  return use;
}

/// `tip`, `middle`: links of the robot. Spans are the whole motion, parts of phases and moments; nothing holds at the
/// start, which keeps no such limit.
inline std::vector<TermUse> every_term(const RobotModel& robot, const std::string& tip, const std::string& middle,
                                       int phases) {
  const PhaseFraction start = PhaseFraction::start_of(0), end = PhaseFraction::end_of(phases - 1);
  const PhaseFraction later{0, 0.5}, end_of_first = PhaseFraction::end_of(0);
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0).toRotationMatrix();
  return {
      over(limit_on("tip", frame_position(tip), -1.0, 1.0), later, end),
      over(limit_on("tip from middle", frame_position(tip, middle), -1.0, 1.0), later, later),
      over(limit_on("orientation", frame_orientation(tip, turned), -1.0, 1.0), later, end_of_first),
      over(limit_on("velocity", frame_velocity(tip), -1.0, 1.0), later, end),
      over(limit_on("angular velocity", frame_angular_velocity(middle), -1.0, 1.0), end_of_first, end_of_first),
      over(limit_on("looks ahead", frame_pointing_along(kBaseFrame, {1.0, 0.0, 0.0}, {1.0, 0.2, 0.1}), -0.5, 0.5),
           later, end),
      over(limit_on("centre", center_of_mass(), 0.1, 0.1), later, end),
      over(limit_on("angular momentum", angular_momentum(), -9.0, 9.0), later, end),
      over(limit_on("joints", joint_positions(robot, {0, 2}), -1.0, 1.0), later, end),
      over(limit_on("torques", joint_torques(robot, {1, 3}), -20.0, 20.0), start, end),
      over(limit_on("force", contact_force(robot.contacts()[2].name), -900.0, 900.0), later, end),
      over(cost_on("tip cost", frame_position(tip, middle), 3.0, 0.1), start, end),
      over(cost_on("orientation cost", frame_orientation(middle, turned, tip), 2.0, 0.1), start, end_of_first),
      over(cost_on("velocity cost", frame_velocity(middle), 0.7, 0.2), later, end),
      over(cost_on("angular velocity cost", frame_angular_velocity(tip), 0.5, 0.2), end, end),
      over(cost_on("looks there", frame_pointing_at(middle, {0.0, 0.0, 1.0}, {2.0, 1.0, 3.0}), 1.5, 0.0), start, end),
      over(cost_on("centre's velocity", center_of_mass_velocity(), 0.9, 0.1), start, end),
      over(cost_on("angular momentum cost", angular_momentum(), 0.4, 0.1), start, end),
      over(cost_on("rates", joint_rates(robot, {1}), 0.3, 0.0), later, later),
      over(cost_on("torque peaks", torque_peaks(robot), 5.0, 0.0), start, end),
      over(cost_on("force cost", contact_force(robot.contacts()[0].name), 1e-4, 100.0), start, end),
      over(cost_on("last force", contact_force(robot.contacts()[2].name), 1e-4, 50.0), end_of_first, end_of_first),
      over(cost_on("power", power_of_first_joint(robot), 1e-3, 1.0), start, end),
  };
}

}  // namespace prowl::test
