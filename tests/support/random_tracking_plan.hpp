#pragma once

#include <random>
#include <string>

#include "prowl/tracker/tracking_plan.hpp"
#include "tests/support/random_vector.hpp"

namespace prowl::test {

/// Three segments with random references and gains, 4 contacts, the last joint without a torque limit, a torque curve
/// over position, one over velocity and one for negative torques alone. For `joints` >= 3.
inline TrackingPlan random_tracking_plan(int joints = 12, int samples_each = 11, unsigned seed = 1) {
  std::mt19937 rng(seed);
  TrackingPlan plan;
  for (int j = 0; j < joints; ++j) plan.joint_names.push_back("joint_" + std::to_string(j));
  plan.contact_names = {"lf", "rf", "lh", "rh"};
  plan.torque_limit = Eigen::VectorXd::Constant(joints, 150.0);
  plan.torque_limit(joints - 1) = std::numeric_limits<double>::infinity();
  using enum TrackingPlan::Torques;
  plan.torque_curves = {{0, false, both, -1.0, 1.0, Eigen::Vector3d(20.0, 100.0, 40.0)},
                        {1, true, both, -5.0, 5.0, Eigen::Vector3d(120.0, 90.0, 10.0)},
                        {2, false, negative, -1.0, 1.0, Eigen::Vector3d(30.0, 30.0, 30.0)}};
  for (int s = 0; s < 3; ++s) {
    plan.segments.push_back({"phase " + std::to_string(s),
                             0.5 * s,
                             0.5 * (s + 1),
                             s * samples_each,
                             samples_each,
                             {true, true, s != 1, true}});
  }
  const int samples = 3 * samples_each;
  const auto random = [&](int rows, double size) {
    return Eigen::Map<const Eigen::MatrixXd>(random_vector(rng, rows * samples, size).data(), rows, samples).eval();
  };
  plan.q = random(plan.nq(), 1.0);
  plan.q.middleRows<4>(3).colwise().normalize();
  plan.v = random(plan.nv(), 1.0);
  plan.tau = random(plan.nu(), 50.0);
  plan.gains = random(2 * plan.nu() * plan.nv(), 10.0);
  return plan;
}

}  // namespace prowl::test
