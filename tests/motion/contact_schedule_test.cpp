#include "prowl/motion/contact_schedule.hpp"

#include <gtest/gtest.h>

#include "tests/support/robots.hpp"

namespace prowl {
namespace {

/// Phases of HyQ with these contacts, on the floor.
MotionProblem phases(const std::vector<std::vector<int>>& contacts) {
  MotionProblem problem{.robot = test::hyq()};
  problem.surfaces = {Surface{}};
  for (const std::vector<int>& held : contacts) {
    Phase& phase = problem.phases.emplace_back();
    for (const int contact : held) phase.contacts.push_back({contact, 0});
  }
  return problem;
}

TEST(ContactSchedule, ATrotHasAStanceAndASwingAFootAndPhase) {
  const MotionProblem problem = phases({{0, 1, 2, 3}, {0, 3}, {1, 2}, {0, 1, 2, 3}});
  const ContactSchedule schedule(problem);
  EXPECT_EQ(schedule.stances().size(), 8u);
  EXPECT_EQ(schedule.swings().size(), 4u);

  // Foot 0 stands through phases 0 and 1, swings in 2, lands in 3.
  const ContactStance& first = schedule.stances()[schedule.stance(0, 0)];
  EXPECT_EQ(first.contact, 0);
  EXPECT_EQ(first.last_phase, 1);
  EXPECT_FALSE(first.lands());
  EXPECT_EQ(schedule.stance(1, 0), schedule.stance(0, 0));
  EXPECT_FALSE(schedule.opens(0, 0));
  EXPECT_TRUE(schedule.opens(1, 0));
  EXPECT_TRUE(schedule.lands(3, 0));
  EXPECT_FALSE(schedule.lands(0, 0));
  EXPECT_FALSE(schedule.opens(3, 0)) << "the motion ends with it closed";

  // Foot 1 opens at the end of phase 0, lands in 2 and stays.
  EXPECT_TRUE(schedule.opens(0, 1));
  EXPECT_TRUE(schedule.lands(2, 0));
  EXPECT_FALSE(schedule.lands(3, 1)) << "it is there already";
  for (const ContactSwing& swing : schedule.swings()) {
    EXPECT_EQ(swing.first_phase, swing.last_phase);
    EXPECT_EQ(schedule.stances()[swing.before].contact, swing.contact);
    EXPECT_EQ(schedule.stances()[swing.after].first_phase, swing.last_phase + 1);
  }
}

TEST(ContactSchedule, ContactsThatAreNeverHeldSwingAllTheTime) {
  const MotionProblem problem = phases({{1, 2, 3}, {1, 2, 3}});
  const ContactSchedule schedule(problem);
  ASSERT_EQ(schedule.swings().size(), 1u);
  const ContactSwing& swing = schedule.swings()[0];
  EXPECT_EQ(swing.contact, 0);
  EXPECT_EQ(swing.before, -1);
  EXPECT_EQ(swing.after, -1);
  EXPECT_EQ(swing.last_phase, 1);
}

}  // namespace
}  // namespace prowl
