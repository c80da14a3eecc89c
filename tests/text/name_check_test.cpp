#include "prowl/text/name_check.hpp"

#include <gtest/gtest.h>

#include <string>

namespace prowl {
namespace {

TEST(NameCheck, AcceptsExactlyPrintableAsciiThatNoFormatTakesForItsOwn) {
  int accepted = 0;
  for (int c = 0; c < 256; ++c) {
    const std::string name = std::string("a") + static_cast<char>(c) + "b";
    const bool expected = c >= 32 && c < 127 && std::string(",\"'\\").find(static_cast<char>(c)) == std::string::npos;
    EXPECT_EQ(is_name(name), expected) << c;
    accepted += is_name(name) ? 1 : 0;
  }
  EXPECT_EQ(accepted, 95 - 4);
}

TEST(NameCheck, AcceptsNamesOfRealRobots) {
  for (const char* name : {"lf_haa_joint", "LF_FOOT", "robot::leg.1/foot", "left foot", "foot <1>"})
    EXPECT_TRUE(is_name(name));
  for (const char* name : {"", " foot", "foot ", " "}) EXPECT_FALSE(is_name(name));
}

}  // namespace
}  // namespace prowl
