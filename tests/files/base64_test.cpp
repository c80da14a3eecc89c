#include "prowl/files/base64.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace prowl {
namespace {

// The bytes of 1, 2, 3 as 32-bit floats are 00 00 80 3f, 00 00 00 40, 00 00 40 40; encoded by RFC 4648's table.
TEST(Base64, IsThatOfTheRfcWithEveryPadding) {
  const std::vector<float> numbers = {1.0f, 2.0f, 3.0f};
  EXPECT_EQ(base64(std::span<const float>()), "");
  EXPECT_EQ(base64(std::span<const float>(numbers.data(), 1)), "AACAPw==");
  EXPECT_EQ(base64(std::span<const float>(numbers.data(), 2)), "AACAPwAAAEA=");
  EXPECT_EQ(base64(numbers), "AACAPwAAAEAAAEBA");
  EXPECT_EQ(base64(std::vector<std::uint32_t>{0xfbefbefbu}), "+77v+w==");
}

}  // namespace
}  // namespace prowl
