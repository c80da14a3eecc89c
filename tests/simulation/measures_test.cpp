#include "prowl/simulation/measures.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prowl/simulation/physics.hpp"
#include "tests/simulation/standing_tracker.hpp"

namespace prowl {
namespace {

/// As in a quick trot: lf_foot lands 50 ms late, on a stance of all feet that lasts 30 ms.
TEST(Measures, FindALandingThatIsLaterThanAShortPhase) {
  MotionProblem problem = test::standing_problem();
  problem.phases.assign(5, problem.phases.front());
  problem.phases[1].contacts.erase(problem.phases[1].contacts.begin());
  problem.phases[3].contacts.pop_back();
  TrackingPlan plan = test::standing_tracker(problem).plan();
  plan.segments = {{"four", 0.0, 0.5, 0, 2, {true, true, true, true}},
                   {"without lf", 0.5, 1.0, 2, 2, {false, true, true, true}},
                   {"four, shortly", 1.0, 1.03, 4, 2, {true, true, true, true}},
                   {"without the last", 1.03, 1.5, 6, 2, {true, true, true, false}},
                   {"four again", 1.5, 2.0, 8, 2, {true, true, true, true}}};
  for (Eigen::MatrixXd* part : {&plan.q, &plan.v, &plan.tau, &plan.gains}) *part = part->replicate(1, 5).eval();
  const Tracker tracker(plan);
  const Physics physics(problem.robot, problem.surfaces, {});
  Measures measures(problem, tracker, physics, 2.0);
  const Eigen::VectorXd& q = problem.start_configuration();
  const Eigen::VectorXd v = Eigen::VectorXd::Zero(problem.robot.nv());
  const std::vector<Eigen::Vector3d> places = physics.contact_positions(q);
  for (int k = 0; k <= 2000; ++k) {
    SimulationSample sample{.time = 1e-3 * k, .q_ref = q, .v_ref = v, .q = q, .v = v, .q_seen = q, .v_seen = v};
    const TrackingPlan::Segment& segment = tracker.segment(sample.time);
    for (std::size_t c = 0; c < places.size(); ++c) {
      const bool is_late = c == 0 && sample.time >= 1.0 && sample.time < 1.0499;
      ContactReading reading;
      reading.surface = segment.in_contact[c] && !is_late ? 0 : -1;
      reading.position = places[c];
      sample.contacts.push_back(reading);
    }
    measures.add(sample, std::vector<Eigen::Vector3d>(places.size(), Eigen::Vector3d::Zero()));
  }
  const SimulationResult result = measures.result();
  ASSERT_EQ(result.switches.size(), 4u);
  for (const ContactSwitch& change : result.switches) {
    const double late = change.contact == 0 && change.lands ? 0.05 : 0.0;
    EXPECT_NEAR(change.measured - change.planned, late, 1.5e-3) << "contact " << change.contact;
    EXPECT_LT(change.off, 1e-9);
  }
}

}  // namespace
}  // namespace prowl
