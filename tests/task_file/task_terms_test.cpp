#include "prowl/task_file/task_terms.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "prowl/task_file/task_file.hpp"
#include "tests/support/task_test.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

class TaskTerms : public test::TaskTest {
 protected:
  std::string with(const std::string& term) { return test::kTaskFile + ("\n[[term]]\n" + term); }
  TermUse only(const std::string& term) {
    const Task task = read(with(term));
    EXPECT_EQ(task.problem.terms.size(), 1u);
    return task.problem.terms.at(0);
  }
};

TEST_F(TaskTerms, HasBoundsOrIsExactOrFree) {
  const TermUse use = only("frame = \"trunk\"\nposition_m = [0.1, \"free\", [0.2, 0.9]]\ntime_s = 0.4\n");
  EXPECT_EQ(use.name, "term 1");
  EXPECT_EQ(use.term->reads().at(0).frame, "trunk");
  EXPECT_EQ(use.lower, Eigen::Vector3d(0.1, -INFINITY, 0.2));
  EXPECT_EQ(use.upper, Eigen::Vector3d(0.1, INFINITY, 0.9));
  EXPECT_TRUE(use.is_moment());
  EXPECT_FALSE(use.is_cost());
}

TEST_F(TaskTerms, IsACostWithAWeight) {
  const TermUse use = only("name = \"centre\"\ncom_m = [0.1, \"free\", 0.5]\nweight = [1, 2, 3]\n");
  EXPECT_EQ(use.name, "centre");
  EXPECT_EQ(use.weight, Eigen::Vector3d(1.0, 0.0, 3.0));
  EXPECT_EQ(use.reference, Eigen::Vector3d(0.1, 0.0, 0.5));
  EXPECT_TRUE(use.is_cost());
  EXPECT_TRUE(use.holds_at(0, 0.0) && use.holds_at(0, 1.0));
}

TEST_F(TaskTerms, HoldsForATimeOrAPhase) {
  const auto span = [&](const std::string& when) {
    const TermUse use = only("com_velocity_mps = [[-1, 1], \"free\", \"free\"]\n" + when);
    return std::array{use.from.fraction, use.to.fraction};
  };
  const double duration = read(test::kTaskFile).problem.phases.at(0).duration.max;
  EXPECT_NEAR(span(fmt::format("time_s = [{}, {}]\n", 0.2 * duration, 0.6 * duration))[0], 0.2, 1e-12);
  EXPECT_NEAR(span(fmt::format("time_s = [0, {}]\n", 0.6 * duration))[1], 0.6, 1e-12);
  const std::string phase = read(test::kTaskFile).problem.phases.at(0).name;
  EXPECT_EQ(span("phase = \"" + phase + "\"\n"), (std::array{0.0, 1.0}));
  EXPECT_EQ(span("phase = \"" + phase + "\"\nfraction = [0.2, 1]\n"), (std::array{0.2, 1.0}));
  EXPECT_EQ(span("phase = \"" + phase + "\"\nfraction = 1\n"), (std::array{1.0, 1.0}));
}

TEST_F(TaskTerms, PointsWithinAnAngle) {
  const TermUse use = only("frame = \"base\"\naxis = [1, 0, 0]\npoints_at_m = [9, 0, 0]\nwithin_rad = 0.2\n");
  EXPECT_EQ(use.lower, Eigen::Vector2d(-0.2, -0.2));
  EXPECT_EQ(use.upper, Eigen::Vector2d(0.2, 0.2));
}

TEST_F(TaskTerms, TurnsWithinAnAngleAboutEachAxis) {
  const TermUse use = only("frame = \"trunk\"\norientation_rpy_rad = [0, 0, 0]\nwithin_rad = 0.1\n");
  EXPECT_EQ(use.lower, Eigen::Vector3d::Constant(-0.1));
  EXPECT_EQ(use.upper, Eigen::Vector3d::Constant(0.1));
}

TEST_F(TaskTerms, SaysWhatIsWrong) {
  const auto said = [&](const std::string& term) { return message_of(with(term)); };
  EXPECT_THAT(said("frame = \"trunc\"\nposition_m = [0, 0, 0]\n"),
              testing::AllOf(HasSubstr("term[0].frame"), HasSubstr("did you mean 'trunk'?")));
  EXPECT_THAT(said("frame = \"trunk\"\n"), HasSubstr("holds nothing; need one of position_m, "));
  EXPECT_THAT(said("position_m = [0, 0, 0]\n"), HasSubstr("frame"));
  EXPECT_THAT(said("com_m = [0, 0, 0]\ncom_velocity_mps = [0, 0, 0]\n"),
              HasSubstr("com_velocity_mps: com_m is here, too; need one quantity in each [[term]]"));
  EXPECT_THAT(said("com_m = [0, 0, 0]\nframe = \"trunk\"\n"), HasSubstr("has no meaning beside com_m"));
  EXPECT_THAT(said("com_m = [\"free\", \"free\", \"free\"]\n"), HasSubstr("limits nothing"));
  EXPECT_THAT(said("com_m = [[0, 1], 0, 0]\nweight = 1\n"), HasSubstr("a range has no weight"));
  EXPECT_THAT(said("com_m = [0, 0, 0]\nweight = 0\n"), HasSubstr("weighs nothing"));
  EXPECT_THAT(said("frame = \"trunk\"\npoints_along = [0, 0, 0]\naxis = [1, 0, 0]\n"), HasSubstr("too short"));
  EXPECT_THAT(said("com_m = [0, 0, 9]\n"), HasSubstr("at the start"));
  EXPECT_THAT(said("com_m = [\"free\", \"free\", [0, 9]]\ntime_s = [0.1, 0.4]\n"),
              HasSubstr("time_s: 0.1 is not at a node of the mesh"));
  EXPECT_THAT(said("com_m = [0, 0, 0.5]\nweight = 1\n[[term]]\nname = \"term 1\"\ncom_m = [0, 0, 0.5]\nweight = 1\n"),
              HasSubstr("already another term"));
}

}  // namespace
}  // namespace prowl
