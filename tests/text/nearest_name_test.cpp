#include "prowl/text/nearest_name.hpp"

#include <gtest/gtest.h>

namespace prowl {
namespace {

TEST(NearestName, IsTheOneWithTheFewestChangedLetters) {
  const std::vector<std::string> names = {"lf_foot", "lh_foot", "rf_foot", "trunk"};
  EXPECT_EQ(nearest_name("lf_fot", names), "lf_foot");                // one missing
  EXPECT_EQ(nearest_name("rf__foot", names), "rf_foot");              // one added
  EXPECT_EQ(nearest_name("trumk", names), "trunk");                   // one changed
  EXPECT_EQ(nearest_name("sotp", {"step", "sofa", "stop"}), "stop");  // two swapped: one mistake
  EXPECT_EQ(nearest_name("LH_FOOT", names), "lh_foot");               // case does not count
  EXPECT_EQ(nearest_name("trunk", names), "trunk");
}

TEST(NearestName, IsEmptyWhereThereIsNone) {
  EXPECT_EQ(nearest_name("foot", {}), "");
  EXPECT_EQ(nearest_name(std::string(1'000'000, 'x'), {"foot"}), "") << "longer than any name";
  EXPECT_EQ(did_you_mean("foot", {}), "");
  EXPECT_EQ(did_you_mean("fot", {"foot"}), "; did you mean 'foot'?");
}

}  // namespace
}  // namespace prowl
