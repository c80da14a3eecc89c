#include "prowl/mpc/horizon_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/mpc/trot.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;
using test::Trot;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(HorizonBounds, LimitsAreThoseOfTheRobot) {
  Trot trot;
  for (int k = 0; k < trot.options.steps; ++k) {
    for (int j = 0; j < trot.robot.nu(); ++j) {
      EXPECT_NEAR(trot.upper(k, trot.program.torque_row(j)), trot.robot.torque_limit()(j), 1e-9);
      EXPECT_NEAR(trot.lower(k, trot.program.torque_row(j)), -trot.robot.torque_limit()(j), 1e-9);
      EXPECT_NEAR(trot.upper(k, trot.program.velocity_row(j)), trot.robot.velocity_limit()(j), 1e-9);
      EXPECT_NEAR(trot.lower(k, trot.program.position_row(j)), trot.robot.position_lower()(j), 1e-9);
      EXPECT_NEAR(trot.upper(k, trot.program.position_row(j)), trot.robot.position_upper()(j), 1e-9);
    }
  }
}

TEST(HorizonBounds, FeetThatStandKeepFriction) {
  Trot trot;
  for (int k = 0; k < trot.options.steps; ++k) {
    for (int foot = 0; foot < 4; ++foot) {
      const bool stands = (trot.program.step(k).standing >> foot & 1U) != 0;
      for (int i = 0; i < 4; ++i)
        EXPECT_EQ(trot.lower(k, trot.program.friction_row(foot) + i), stands ? 0.0 : -kInfinity) << k << ' ' << foot;
    }
  }
}

TEST(HorizonBounds, FeetSwingAboveTheGroundAndLandSlowly) {
  Trot trot;
  double highest = 0.0, fastest_before_landing = kInfinity;
  for (int k = 0; k < trot.options.steps && trot.grid.time(k + 1) < 0.2 + 1e-9; ++k) {
    EXPECT_LE(trot.lower_height(k, 0), trot.upper_height(k, 0)) << k;
    highest = std::max(highest, trot.lower_height(k, 0));
    fastest_before_landing = trot.upper(k, trot.program.contact_velocity_row(0));
    EXPECT_EQ(trot.lower_height(k, 1), -kInfinity) << "it stands";
  }
  const double clearance = trot.options.clearance * trot.program.standing_posture().z();
  EXPECT_NEAR(highest, clearance, 0.1 * clearance);
  EXPECT_LT(fastest_before_landing, 1.0);
  EXPECT_GT(fastest_before_landing, 0.0);
}

TEST(HorizonBounds, AFootLandsOnTheGround) {
  Trot trot;
  const int landing = trot.grid.step_at(0.2 + 1e-6);
  EXPECT_NEAR(trot.grid.time(landing), 0.2, 1e-9);
  EXPECT_LT(trot.upper_height(landing, 0), 0.0);
  EXPECT_GT(trot.lower_height(landing, 0), -0.01);
}

/// Else a plan buys a foothold in the air where legs are fast, and the robot falls.
TEST(HorizonBounds, AShortStepMakesALandingNoCheaper) {
  Trot trot;
  const auto price_of_landing = [&](double start) {
    trot.lay(start);
    const int landing = trot.grid.step_at(0.2 + 1e-6);
    return trot.solver.rows(landing).penalty()(trot.program.height_row(0));
  };
  const double soon = price_of_landing(0.195);
  EXPECT_LT(trot.grid.step(1), 0.02) << "the step of the landing";
  trot.lay(0.0);
  const double of_shortest_step = trot.options.weights.penalty * trot.grid.step(0);
  EXPECT_GT(soon, 2.0 * of_shortest_step);
  for (const double start : {0.0, 0.05, 0.1, 0.15}) EXPECT_EQ(price_of_landing(start), soon) << start;
}

/// A foot that finds no ground searches below it.
TEST(HorizonBounds, ALateFootLandsLower) {
  Trot trot;
  const double on_time = trot.upper_height(trot.grid.step_at(0.2 + 1e-6), 0);
  for (double t = 0.2; t < 0.25; t += 0.01) trot.timeline.feel(0, false, t, 0.01);
  const double landing = trot.timeline.swing(0, 0.245)->land;
  trot.lay(0.245);
  EXPECT_LT(trot.upper_height(trot.grid.step_at(landing + 1e-6), 0), on_time - 0.005);
}

TEST(HorizonBounds, ALandingThatIsNotFeltYetCarriesLittle) {
  Trot trot;
  const int landing = trot.grid.step_at(0.2 + 1e-6);
  // Sum of two opposite rows, each a part of sqrt(2) friction times the normal force.
  const double most = 2.0 * trot.upper(landing, trot.program.friction_row(0)) / std::sqrt(2.0) / trot.options.friction;
  EXPECT_GT(most, 0.05 * trot.robot.weight());
  EXPECT_LT(most, 0.5 * trot.robot.weight());
  EXPECT_EQ(trot.upper(landing, trot.program.friction_row(1)), kInfinity) << "it has stood";
  trot.timeline.feel(0, true, 0.199, 0.0);
  trot.lay(0.199);
  EXPECT_EQ(trot.upper(1, trot.program.friction_row(0)), kInfinity) << "it was felt";
}

TEST(HorizonBounds, HeightsAreAboveTheGroundThatWasSeen) {
  Trot level, raised;
  for (int contact = 0; contact < 4; ++contact)
    raised.ground.see(contact, {contact % 2 == 0 ? 0.3 : -0.3, contact < 2 ? 0.2 : -0.2, 0.1});
  raised.ground.fit(1.0);
  raised.lay(0.0);
  for (int k = 0; k < level.options.steps; ++k) {
    for (int foot = 0; foot < 4; ++foot) {
      if (level.lower_height(k, foot) == -kInfinity) continue;
      EXPECT_NEAR(raised.lower_height(k, foot) - level.lower_height(k, foot), 0.1, 1e-9) << k << ' ' << foot;
    }
  }
}

}  // namespace
}  // namespace prowl
