#pragma once

#include "prowl/mpc/horizon_bounds.hpp"
#include "tests/support/robots.hpp"

namespace prowl::test {

/// Two feet of HyQ swing from 0 to 0.2 s, while the robot stands on level ground.
struct Trot {
  MpcOptions options;
  RobotModel robot{hyq_description()};
  HorizonProgram program{robot, options.weights, options.friction, options.steps};
  HorizonSolver solver{program, options.barrier, options.iterations, options.feedback_iterations};
  HorizonGrid grid{options.steps, options.first_step, options.least_horizon};
  ContactTimeline timeline{4, 0.0};
  GroundPlane ground{4, robot.size()};
  HorizonBounds bounds{program, options};

  explicit Trot(double start = 0.0, const MpcOptions& with = {}) : options(with) {
    timeline.follow({.groups = {{0, 3}, {1, 2}}, .stride = 0.5, .duty_factor = 0.6});
    timeline.extend(0.0, 1.5);
    lay(start);
  }
  void lay(double start) {
    grid.lay(start, timeline);
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(robot.nv());
    for (int k = 0; k < options.steps; ++k) {
      program.set_stage(k, program.standing_posture(), still, still, Eigen::VectorXd::Zero(robot.nu()));
      program.step(k).length = program.step(k).contact_time = grid.step(k);
      program.step(k).standing = timeline.standing(grid.middle(k));
    }
    bounds.set(grid, timeline, ground, solver);
  }
  double lower(int k, int row) { return solver.rows(k).lower()(row) * program.row_unit(row); }
  double upper(int k, int row) { return solver.rows(k).upper()(row) * program.row_unit(row); }
  double lower_height(int k, int foot) { return lower(k, program.height_row(foot)); }
  double upper_height(int k, int foot) { return upper(k, program.height_row(foot)); }
};

}  // namespace prowl::test
