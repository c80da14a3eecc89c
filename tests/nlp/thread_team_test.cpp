#include "prowl/nlp/thread_team.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace prowl {
namespace {

TEST(ThreadTeam, CallsEachIndexOnceWhateverTheCount) {
  for (const int count : {1, 2, 3, 8}) {
    ThreadTeam team(count);
    for (const int size : {0, 1, 2, 7, 100}) {
      std::vector<int> calls(static_cast<std::size_t>(size), 0);
      team.for_each(size, [&](int i) { ++calls[i]; });
      EXPECT_EQ(calls, std::vector<int>(static_cast<std::size_t>(size), 1)) << count << " threads, " << size;
    }
  }
}

TEST(ThreadTeam, ASlotIsOneThread) {
  constexpr int kCount = 3, kSize = 60;
  ThreadTeam team(kCount);
  std::vector<int> slots(kSize, -1);
  std::vector<std::thread::id> threads(kSize);
  team.for_each(kSize, [&](int i) {
    slots[i] = ThreadTeam::slot();
    threads[i] = std::this_thread::get_id();
  });
  EXPECT_EQ(std::set<int>(slots.begin(), slots.end()), (std::set<int>{0, 1, 2}));
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t j = 0; j < kSize; ++j) {
      if (slots[i] == slots[j]) EXPECT_EQ(threads[i], threads[j]) << i << ", " << j;
    }
  }
  EXPECT_EQ(threads.front(), std::this_thread::get_id());
  EXPECT_EQ(ThreadTeam::slot(), 0);
}

TEST(ThreadTeam, ATeamInsideAnotherHasSlotsOfItsOwn) {
  ThreadTeam outer(3);
  outer.for_each(3, [](int i) {
    const int before = ThreadTeam::slot();
    EXPECT_EQ(before, i);
    ThreadTeam(1).for_each(2, [](int) { EXPECT_EQ(ThreadTeam::slot(), 0); });
    EXPECT_EQ(ThreadTeam::slot(), before);
    ThreadTeam(2).for_each(2, [](int j) { EXPECT_EQ(ThreadTeam::slot(), j); });
    EXPECT_EQ(ThreadTeam::slot(), before);
  });
}

TEST(ThreadTeam, WhatTheSmallestIndexThrewGoesOn) {
  for (const int count : {1, 2, 4}) {
    ThreadTeam team(count);
    const auto some_throw = [](int i) {
      if (i == 13 || i == 14 || i == 37) throw std::runtime_error(std::to_string(i));
    };
    for (int repeat = 0; repeat < 20; ++repeat) {
      try {
        team.for_each(40, some_throw);
        FAIL() << "nothing thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "13") << count << " threads";
      }
      EXPECT_EQ(ThreadTeam::slot(), 0);
    }
    std::vector<int> calls(5, 0);
    team.for_each(5, [&](int i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(5, 1)) << "of no use after a throw";
  }
}

}  // namespace
}  // namespace prowl
