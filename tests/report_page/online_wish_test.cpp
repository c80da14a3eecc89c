#include "prowl/report_page/online_wish.hpp"

#include <gtest/gtest.h>

#include "prowl/error.hpp"

namespace prowl {
namespace {

TEST(OnlineWish, IsACommandOrAKickOrBoth) {
  const OnlineWish both =
      parse_wish(R"({"forward": 0.3, "left": -0.1, "turn": 0.2, "height": 0, "gait": "walk", "kick": 0.5})");
  ASSERT_TRUE(both.command && both.kick);
  EXPECT_EQ(both.command->command, (MpcCommand{0.3, -0.1, 0.2, 0.0}));
  EXPECT_EQ(both.command->gait, "walk");
  EXPECT_EQ(*both.kick, 0.5);

  const OnlineWish kick = parse_wish(R"({"kick": 1})");
  EXPECT_TRUE(kick.kick && !kick.command);
  const OnlineWish command = parse_wish(R"({"forward": 0, "left": 0, "turn": 0, "height": 0.02})");
  EXPECT_TRUE(command.command && !command.kick);
  EXPECT_EQ(command.command->gait, "");  // as before
}

TEST(OnlineWish, WhatIsNoneIsRefused) {
  for (const char* const text : {"", "[]", "{", "3", R"({"kick": "hard"})", R"({"kick": 5.1})", R"({"kick": 1e999})",
                                 R"({"forward": 0.1})", R"({"forward": 1, "left": 0, "turn": null, "height": 0})"})
    EXPECT_THROW(parse_wish(text), InputError) << text;
}

}  // namespace
}  // namespace prowl
