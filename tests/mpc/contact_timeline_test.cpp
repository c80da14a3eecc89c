#include "prowl/mpc/contact_timeline.hpp"

#include <gtest/gtest.h>

#include "prowl/error.hpp"

namespace prowl {
namespace {

const SteppingPattern kTrot{.groups = {{0, 3}, {1, 2}}, .stride = 0.5, .duty_factor = 0.6};

TEST(ContactTimeline, StandsUntilAPatternBegins) {
  ContactTimeline timeline(4, 0.0);
  timeline.extend(0.0, 1.0);
  timeline.follow(kTrot);
  timeline.extend(0.0, 3.0);
  std::vector<double> early;
  timeline.add_switches(0.0, 1.0 - 1e-9, early);
  EXPECT_TRUE(early.empty()) << "what was planned has changed";
  EXPECT_NE(timeline.swing(0, 1.05), nullptr);
}

TEST(ContactTimeline, EachFootSwingsOnceAStride) {
  ContactTimeline timeline(4, 0.0);
  timeline.follow(kTrot);
  timeline.extend(0.0, 10.0);
  for (int foot = 0; foot < 4; ++foot) {
    int swinging = 0;
    constexpr int kSamples = 9000;
    for (int i = 0; i < kSamples; ++i) swinging += timeline.swing(foot, 0.5 + 9.0 * i / kSamples) ? 1 : 0;
    EXPECT_NEAR(swinging / static_cast<double>(kSamples), 1.0 - kTrot.duty_factor, 1e-3) << foot;
  }
  // A pair together, the pairs in turn.
  for (double t = 0.01; t < 9.0; t += 0.013) {
    EXPECT_EQ(timeline.swing(0, t) == nullptr, timeline.swing(3, t) == nullptr) << t;
    EXPECT_TRUE(!timeline.swing(0, t) || !timeline.swing(1, t)) << t;
  }
}

TEST(ContactTimeline, AnEarlyFootHasLanded) {
  ContactTimeline timeline(4, 0.0);
  timeline.follow(kTrot);
  timeline.extend(0.0, 2.0);
  timeline.feel(0, true, 0.05, 0.0);
  EXPECT_NE(timeline.swing(0, 0.06), nullptr) << "touches in the first half of a swing are those of the lift-off";
  timeline.feel(0, true, 0.15, 0.0);
  EXPECT_EQ(timeline.swing(0, 0.15), nullptr);
  EXPECT_EQ(timeline.lateness(0, 0.15, 0.15), 0.0);
}

TEST(ContactTimeline, ALateFootIsAwaited) {
  ContactTimeline timeline(4, 0.0);
  timeline.follow(kTrot);
  timeline.extend(0.0, 2.0);
  for (double t = 0.19; t < 0.25; t += 0.001) timeline.feel(0, false, t, 0.01);
  EXPECT_NE(timeline.swing(0, 0.255), nullptr);
  const double landing = timeline.swing(0, 0.255)->land;
  EXPECT_NEAR(timeline.lateness(0, landing, 0.25), 0.05, 1e-9);
  timeline.extend(0.0, 2.0);
  const ContactTimeline::Swing* const next = timeline.swing(0, 0.65);
  ASSERT_NE(next, nullptr);
  EXPECT_EQ(timeline.lateness(0, next->land, 0.25), 0.0) << "the next landing is on time";
  timeline.feel(0, true, 0.25, 0.01);
  EXPECT_EQ(timeline.swing(0, 0.25), nullptr);
  // Not for ever.
  ContactTimeline lost(4, 0.0);
  lost.follow(kTrot);
  lost.extend(0.0, 2.0);
  for (double t = 0.0; t < 0.45; t += 0.001) lost.feel(0, false, t, 0.01);
  EXPECT_EQ(lost.swing(0, 0.2 + ContactTimeline::kMostLate + 0.011), nullptr);
}

TEST(ContactTimeline, GoesOnAfterALongPause) {
  ContactTimeline timeline(4, 0.0), steady(4, 0.0);
  timeline.follow(kTrot);
  steady.follow(kTrot);
  timeline.extend(0.0, 1.0);
  for (double t = 0.0; t < 100.0; t += 0.5) steady.extend(t, t + 1.0);
  timeline.extend(100.0, 101.0);
  steady.extend(100.0, 101.0);
  for (double t = 100.005; t < 101.0; t += 0.01) EXPECT_EQ(timeline.standing(t), steady.standing(t)) << t;
  timeline.extend(1e12, 1e12 + 1.0);  // at once
}

TEST(ContactTimeline, RefusesPatternsThatItCannotFollow) {
  ContactTimeline timeline(4, 0.0);
  SteppingPattern endless = kTrot;
  endless.stride = 0.0;
  EXPECT_THROW(timeline.follow(endless), InputError);
  SteppingPattern always = kTrot;
  always.duty_factor = 1.0;
  EXPECT_THROW(timeline.follow(always), InputError);
  EXPECT_THROW(timeline.follow({.groups = {{4}}}), InputError);
}

}  // namespace
}  // namespace prowl
