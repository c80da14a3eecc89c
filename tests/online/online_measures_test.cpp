#include "prowl/online/online_measures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "prowl/mpc/standing_robot.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using testing::ElementsAre;

struct Measured {
  RobotModel robot{test::hyq_description()};
  OnlineMeasures measures{robot, contacts_of_feet(robot), 0.6, 1.0, standing_on_ground(robot).z()};
  OnlineResult result;
};

TEST(OnlineMeasures, ALegThatTouchesIsAFailure) {
  Measured one;
  one.measures.add_touch("lf_lowerleg and ground");
  one.measures.add_touch("lf_lowerleg and ground");
  one.measures.finish(one.result);
  EXPECT_THAT(one.result.failures, ElementsAre("touched: lf_lowerleg and ground"));
}

TEST(OnlineMeasures, AFallIsTheOnlyFailureThatItTells) {
  Measured one;
  one.measures.add_touch("trunk and ground");
  one.result.end = OnlineResult::End::fell;
  one.result.end_time = 0.5;
  one.measures.finish(one.result);
  EXPECT_THAT(one.result.failures, ElementsAre("fell at 0.50 s"));
}

TEST(OnlineMeasures, WithoutAFailureItIsASuccess) {
  Measured one;
  one.measures.finish(one.result);
  EXPECT_TRUE(one.result.success());
}

}  // namespace
}  // namespace prowl
