#include "screen/phase_table.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

/// A foot goes from the floor to a step; another one hangs in the air all the time.
DiscreteProblem step_up() {
  MotionProblem problem = test::standing_problem();
  problem.name = "step up";
  const Surface step{
      .name = "step", .point = {0.4, 0.3, 0.1}, .patch = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}}};
  problem.surfaces = {Surface{}, step};
  problem.phases = {{"stand", {{1, 0}, {0, 0}, {2, 0}}, {0.5, 0.5}},
                    {"swing", {{1, 0}, {2, 0}}, {0.25, 1.0}},
                    {"land", {{0, 1, step.point}, {1, 0}, {2, 0}}, {1.0, 1.0}}};
  return {std::move(problem), {{PhaseMesh(10), PhaseMesh(8), PhaseMesh(12)}}};
}

TEST(PhaseTable, SaysWhoHoldsWhatAndWhen) {
  EXPECT_EQ(phase_table(step_up()),
            "HyQ step up: 3 phases, 30 intervals, 1.75 to 2.5 s\n"
            "  #  phase     duration  intervals  lf_foot       lh_foot  rf_foot  rh_foot\n"
            "  1  stand        0.5 s         10  floor, opens  floor    floor    -\n"
            "  2  swing  0.25 to 1 s          8  -             floor    floor    -\n"
            "  3  land           1 s         12  step, lands   floor    floor    -\n");
}

TEST(PhaseTable, SaysTheSameAsJson) {
  const auto json = nlohmann::json::parse(phases_json(step_up()));
  EXPECT_EQ(json.at("name"), "step up");
  ASSERT_EQ(json.at("phases").size(), 3u);
  EXPECT_EQ(json.at("phases")[1].at("duration_s"), (std::vector{0.25, 1.0}));
  EXPECT_EQ(json.at("phases")[1].at("intervals"), 8);
  const auto& contacts = json.at("phases")[2].at("contacts");
  ASSERT_EQ(contacts.size(), 3u);
  EXPECT_EQ(contacts[0].at("contact"), "lf_foot");
  EXPECT_EQ(contacts[0].at("surface"), "step");
  EXPECT_EQ(contacts[0].at("lands"), true);
  EXPECT_EQ(contacts[0].at("opens"), false);
  EXPECT_EQ(contacts[0].at("place_m"), (std::vector{0.4, 0.3, 0.1}));
  EXPECT_FALSE(contacts[1].contains("place_m"));
  EXPECT_EQ(json.at("phases")[0].at("contacts")[1].at("opens"), true);
}

}  // namespace
}  // namespace prowl
