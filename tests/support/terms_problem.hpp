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
          .weight = weight * Eigen::VectorXd::LinSpaced(rows, 1.0, 2.0),
          .reference = Eigen::VectorXd::Constant(rows, reference)};
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
      over(limit_on("joints", joint_positions(robot, {0, 2}), -1.0, 1.0), later, end),
      over(cost_on("tip cost", frame_position(tip, middle), 3.0, 0.1), start, end),
      over(cost_on("orientation cost", frame_orientation(middle, turned, tip), 2.0, 0.1), start, end_of_first),
      over(cost_on("velocity cost", frame_velocity(middle), 0.7, 0.2), later, end),
      over(cost_on("angular velocity cost", frame_angular_velocity(tip), 0.5, 0.2), end, end),
      over(cost_on("looks there", frame_pointing_at(middle, {0.0, 0.0, 1.0}, {2.0, 1.0, 3.0}), 1.5, 0.0), start, end),
      over(cost_on("centre's velocity", center_of_mass_velocity(), 0.9, 0.1), start, end),
      over(cost_on("rates", joint_rates(robot, {1}), 0.3, 0.0), later, later),
  };
}

}  // namespace prowl::test
