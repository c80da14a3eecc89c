#include "prowl/model/mirror_name.hpp"

#include <gtest/gtest.h>

namespace prowl {
namespace {

std::string counterpart(const std::string& left, const std::vector<std::string>& names) {
  return right_counterpart(left, names).value_or("none");
}

TEST(MirrorName, FindsTheRightOfEveryNamingStyle) {
  EXPECT_EQ(counterpart("lf_haa_joint", {"lf_haa_joint", "lh_haa_joint", "rf_haa_joint", "rh_haa_joint"}),
            "rf_haa_joint");
  EXPECT_EQ(counterpart("LH_FOOT", {"RF_FOOT", "RH_FOOT"}), "RH_FOOT");
  EXPECT_EQ(counterpart("FL_HAA", {"FR_HAA", "HL_HAA", "HR_HAA"}), "FR_HAA");
  EXPECT_EQ(counterpart("RL_calf_joint", {"FR_calf_joint", "RR_calf_joint"}), "RR_calf_joint");
  EXPECT_EQ(counterpart("leg_left_1_joint", {"leg_right_1_joint"}), "leg_right_1_joint");
  EXPECT_EQ(counterpart("left_front_left", {"right_front_left", "right_front_right"}), "right_front_right");
  EXPECT_EQ(counterpart("left_front_right", {"right_front_left", "right_front_right"}), "right_front_left");
  EXPECT_EQ(counterpart("LHipYaw", {"RHipYaw"}), "RHipYaw");
  EXPECT_EQ(counterpart("l_knee", {"r_knee"}), "r_knee");
}

TEST(MirrorName, FindsEachPairOnceAndNothingElse) {
  EXPECT_EQ(counterpart("rf_haa_joint", {"lf_haa_joint", "rf_haa_joint"}), "none");
  EXPECT_EQ(counterpart("FR_HAA", {"FL_HAA", "FR_HAA"}), "none");
  EXPECT_EQ(counterpart("right_front_left", {"left_front_right"}), "none");
  EXPECT_EQ(counterpart("torso_1_joint", {"torso_1_joint", "torso_2_joint"}), "none");
  EXPECT_EQ(counterpart("self_test", {"serf_test"}), "none") << "'lf' inside a word";
}

}  // namespace
}  // namespace prowl
