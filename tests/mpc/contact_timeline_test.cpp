#include "prowl/mpc/contact_timeline.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "prowl/error.hpp"

namespace prowl {
namespace {

const SteppingPattern kTrot{.groups = {{0, 3}, {1, 2}}, .stride = 0.5, .duty_factor = 0.6};
const SteppingPattern kWalk{.groups = {{0}, {1}, {2}, {3}}, .stride = 0.8, .duty_factor = 0.77};

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

/// A plan that still counts on such a foot pushes with it, and throws the leg up.
TEST(ContactTimeline, AFootThatLosesTheGroundLandsAgain) {
  constexpr double kSoon = 0.01, kLeft = 0.25, kTick = 0.001;
  ContactTimeline trot(4, 0.0), stands(4, 0.0), undisturbed(4, 0.0);
  for (ContactTimeline* timeline : {&trot, &undisturbed}) timeline->follow(kTrot);
  for (ContactTimeline* timeline : {&trot, &stands, &undisturbed}) {
    timeline->extend(0.0, 2.0);
    for (double t = 0.0; t < kLeft; t += kTick) timeline->feel(0, true, t, kSoon);
  }
  for (ContactTimeline* timeline : {&trot, &stands}) {
    const double lost = kLeft + ContactTimeline::kLost;
    for (double t = kLeft; t < lost - kTick; t += kTick) timeline->feel(0, false, t, kSoon);
    EXPECT_EQ(timeline->swing(0, lost - kTick), nullptr) << "may be a foot with little load";
    double t = lost;
    for (; t < lost + 0.02; t += kTick) timeline->feel(0, false, t, kSoon);
    const ContactTimeline::Swing* const swing = timeline->swing(0, t);
    ASSERT_NE(swing, nullptr);
    EXPECT_NEAR(timeline->lateness(0, swing->land, t), t - lost, 2.0 * kTick);
    timeline->feel(0, true, t, kSoon);
    EXPECT_EQ(timeline->swing(0, t), nullptr) << "has landed";
    for (t += kTick; t < 0.45; t += kTick) timeline->feel(0, true, t, kSoon);
    EXPECT_EQ(timeline->swing(0, t), nullptr);
  }
  for (double t = 0.5; t < 1.9; t += 0.013) EXPECT_EQ(trot.standing(t), undisturbed.standing(t)) << t;
}

TEST(ContactTimeline, ALostFootLiftsOffOnTime) {
  constexpr double kSoon = 0.01, kTick = 0.001;
  ContactTimeline trot(4, 0.0), walk(4, 0.0);
  trot.follow(kTrot);
  walk.follow(kWalk);
  for (const auto& [timeline, lift, swing] :
       {std::tuple{&trot, kTrot.stride, kTrot.swing()}, std::tuple{&walk, kWalk.stride, kWalk.swing()}}) {
    timeline->extend(0.0, 2.0);
    double t = 0.0;
    for (; t < lift - 0.05; t += kTick) timeline->feel({true, true, true, true}, t, kSoon);
    for (; t < lift + 0.5 * swing; t += kTick) timeline->feel({false, true, true, true}, t, kSoon);
    ASSERT_NE(timeline->swing(0, lift + kTick), nullptr);
    EXPECT_NEAR(timeline->swing(0, lift + kTick)->lift, lift, 1e-9) << "not the end of another swing";
    EXPECT_NEAR(timeline->swing(0, t)->planned, lift + swing, 1e-9);
  }
}

TEST(ContactTimeline, FeetOfAWalkWaitForALostOne) {
  constexpr double kDelay = 0.01, kTick = 0.001;
  ContactTimeline walk(4, 0.0);
  walk.follow(kWalk);
  walk.extend(0.0, 2.0);
  const double lift = 0.5 * kWalk.stride;  // of foot 2
  double t = 0.0;
  for (; t < lift - 0.08; t += kTick) walk.feel({true, true, true, true}, t, kDelay);
  for (; t < lift + 0.02; t += kTick) walk.feel({false, true, true, true}, t, kDelay);
  EXPECT_FALSE(walk.touches(0));
  EXPECT_NE(walk.swing(0, t), nullptr);
  EXPECT_EQ(walk.swing(2, t), nullptr) << "waits";
  for (const double end = t + 0.1; t < end; t += kTick) walk.feel({true, true, true, true}, t, kDelay);
  EXPECT_EQ(walk.swing(0, t), nullptr);
  EXPECT_NE(walk.swing(2, t), nullptr);
}

TEST(ContactTimeline, AFootIsNotLostJustBeforeItLiftsOff) {
  constexpr double kSoon = 0.01;
  ContactTimeline timeline(4, 0.0);
  timeline.follow(kTrot);
  timeline.extend(0.0, 2.0);
  const double lift = kTrot.stride;
  double t = 0.0;
  for (; t < lift - ContactTimeline::kLost - 0.5 * kSoon; t += 0.001) timeline.feel(0, true, t, kSoon);
  for (; t < lift - 0.001; t += 0.001) timeline.feel(0, false, t, kSoon);
  EXPECT_EQ(timeline.swing(0, lift - 0.001), nullptr);
  EXPECT_NE(timeline.swing(0, lift + 0.001), nullptr);
}

/// With two feet in the air, a robot that walks tips over.
TEST(ContactTimeline, AFootOfAWalkWaitsUntilTheOneBeforeHasLanded) {
  constexpr double kDelay = 0.01, kTick = 0.01;
  ContactTimeline walk(4, 0.0), trot(4, 0.0);
  const SteppingPattern& pattern = kWalk;  // a swing of 0.184 s every 0.2 s
  walk.follow(pattern);
  trot.follow(kTrot);
  for (ContactTimeline* timeline : {&walk, &trot}) timeline->extend(0.0, 2.0);
  const double lift = pattern.stride / 4, landing = pattern.swing();
  for (double t = 0.0; t < landing + 0.05; t += kTick) {
    const std::vector<bool> none_but_late = {false, true, true, true};
    walk.feel(none_but_late, t, kDelay);
    trot.feel(none_but_late, t, kDelay);
    for (double acts = t; t > landing && walk.swing(0, acts); acts += 0.001)
      EXPECT_EQ(walk.swing(1, acts), nullptr) << "unloads a foot without which the robot tips over";
  }
  const ContactTimeline::Swing* const late = walk.swing(0, landing + 0.05);
  ASSERT_NE(late, nullptr);
  EXPECT_EQ(walk.swing(1, lift + 0.01), nullptr) << "waits";
  const ContactTimeline::Swing* const waiting = walk.swing(1, late->land + 0.05);
  ASSERT_NE(waiting, nullptr);
  EXPECT_NEAR(waiting->land - waiting->lift, pattern.swing(), 1e-9);
  EXPECT_NEAR(waiting->planned, waiting->land, 1e-9) << "is not late itself";
  for (double t = 0.0; t < 2.0; t += 0.001) {
    int swinging = 0;
    for (int f = 0; f < 4; ++f) swinging += walk.swing(f, t) ? 1 : 0;
    EXPECT_LE(swinging, 1) << t;
  }
  // The foot has landed: the other lifts off soon, and the rest of the schedule is as it was.
  const double now = landing + 0.05;
  walk.feel({true, true, true, true}, now, kDelay);
  const ContactTimeline::Swing* const next = walk.swing(1, now + 0.03);
  ASSERT_NE(next, nullptr);
  EXPECT_GE(next->lift, now + kDelay) << "the plan that acts by then has it on the ground";
  for (const double after : {0.0, 0.8}) EXPECT_NE(walk.swing(0, pattern.stride + after + 0.01), nullptr);
  // A trot falls from one pair of feet to the other: it does not wait.
  EXPECT_NE(trot.swing(1, kTrot.stride / 2 + 0.001), nullptr);
}

TEST(ContactTimeline, TheLastFeetOfATrotDoNotWaitEither) {
  for (const SteppingPattern& next : {SteppingPattern{}, kWalk}) {
    ContactTimeline timeline(4, 0.0);
    timeline.follow(kTrot);
    timeline.extend(0.0, 0.4);
    timeline.follow(next);
    const double lift = kTrot.stride / 2;
    for (double t = 0.0; t < lift; t += 0.01) timeline.feel({false, true, true, true}, t, 0.02);
    EXPECT_NE(timeline.swing(0, lift + 0.005), nullptr) << "is late";
    EXPECT_NE(timeline.swing(1, lift + 0.005), nullptr);
  }
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
