#include "prowl/solvers/foreign/library_release.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prowl {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(LibraryRelease, OfOneReleaseWillDo) {
  for (const char* loaded : {"3.14.19", "3.14.4", "3.14.20", "3.14"}) {
    EXPECT_EQ(why_other_release("Ipopt", loaded, "3.14.19", "libipopt.so"), std::nullopt) << loaded;
  }
}

TEST(LibraryRelease, AnotherIsNamedWithTheRemedy) {
  for (const char* loaded : {"3.11.9", "3.1", "3.15.0", "4.14.19", "3.140.0", "before 3.14", ""}) {
    const std::string reason = why_other_release("Ipopt", loaded, "3.14.19", "/old/libipopt.so.3").value_or("");
    EXPECT_THAT(reason,
                AllOf(HasSubstr(std::string("/old/libipopt.so.3 is Ipopt ") + loaded),
                      HasSubstr("built with Ipopt 3.14.19"), HasSubstr("LD_LIBRARY_PATH"), HasSubstr("scripts/setup")));
  }
}

TEST(LibraryRelease, InstructionsThatAProcessorLacksAreNamed) {
  EXPECT_EQ(why_missing_instructions("libblasfeo.so", "", ""), std::nullopt) << "generic kernels";
  EXPECT_EQ(why_missing_instructions("libblasfeo.so", "AVX2 FMA ", "SSE3 AVX FMA AVX2"), std::nullopt);
  const std::string reason = why_missing_instructions("libblasfeo.so", "AVX2 FMA SSE3", "SSE3 AVX").value_or("");
  EXPECT_THAT(reason,
              AllOf(HasSubstr("libblasfeo.so needs a processor with AVX2, FMA, which"), Not(HasSubstr("SSE3"))));
}

}  // namespace
}  // namespace prowl
