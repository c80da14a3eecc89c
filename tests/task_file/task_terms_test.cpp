#include "prowl/task_file/task_terms.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "prowl/task_file/task_file.hpp"
#include "prowl/terms/selected_entries.hpp"
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
  EXPECT_EQ(use.term->reads().at(0).name, "trunk");
  EXPECT_EQ(use.lower, Eigen::Vector3d(0.1, -INFINITY, 0.2));
  EXPECT_EQ(use.upper, Eigen::Vector3d(0.1, INFINITY, 0.9));
  EXPECT_TRUE(use.is_moment());
  EXPECT_FALSE(use.is_cost());
}

TEST_F(TaskTerms, IsACostWithAWeight) {
  const TermUse use = only("name = \"centre\"\ncom_m = [0.1, \"free\", 0.5]\nweight = [1, 2, 3]\n");
  EXPECT_EQ(use.name, "centre");
  EXPECT_EQ(use.weight, Eigen::MatrixXd(Eigen::Vector3d(1.0, 0.0, 3.0).asDiagonal()));
  EXPECT_EQ(use.reference, Eigen::Vector3d(0.1, 0.0, 0.5));
  EXPECT_TRUE(use.is_cost());
  EXPECT_TRUE(use.holds_at(0, 0.0) && use.holds_at(0, 1.0));
}

TEST_F(TaskTerms, HasAFullMatrixOfWeights) {
  const std::string center = "com_m = [0.1, \"free\", 0.5]\n";
  const TermUse use = only(center + "weight_matrix = [[2, 9, -1], [9, 9, 9], [-1, 9, 3]]\n");
  EXPECT_EQ(use.weight, (Eigen::Matrix3d() << 2, 0, -1, 0, 0, 0, -1, 0, 3).finished());
  EXPECT_THAT(message_of(with(center + "weight_matrix = [[2, 0, -4], [0, 0, 0], [-4, 0, 3]]\n")),
              HasSubstr("weight: is not positive semidefinite: an eigenvalue is -1.531"));
  EXPECT_THAT(message_of(with(center + "weight_matrix = [[1, 0], [0, 1]]\n")), HasSubstr("weight_matrix"));
  EXPECT_THAT(message_of(with(center + "weight = 1\nweight_matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n")),
              HasSubstr("weight is here, too"));
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

TEST_F(TaskTerms, HasOneSidedBounds) {
  const TermUse use = only("com_m = [[\"free\", 0.4], [-0.5, \"free\"], \"free\"]\n");
  EXPECT_EQ(use.lower, Eigen::Vector3d(-INFINITY, -0.5, -INFINITY));
  EXPECT_EQ(use.upper, Eigen::Vector3d(0.4, INFINITY, INFINITY));
}

TEST_F(TaskTerms, ReadsForcesAndTorques) {
  const TermUse force = only("contact = \"lf_foot\"\nforce_N = [\"free\", \"free\", [\"free\", 300]]\n");
  EXPECT_EQ(force.term->reads().at(0).name, "lf_foot");
  EXPECT_EQ(force.term->unit(), "N");
  const TermUse torque = only("joint_torque_Nm = { lf_kfe_joint = [-90, \"free\"] }\n");
  EXPECT_EQ(torque.lower(0), -90.0);
  EXPECT_EQ(torque.term->unit(), "N m");
}

/// A term of one's own that a program gives.
class OwnTaskTerms : public TaskTerms {
 protected:
  Task read_own(const std::string& term, OwnTerms own = {}) {
    if (own.known.empty()) own.known["height"] = center_of_mass();
    folder_.write("hyq.toml", test::kHyqFile);
    return read_task_file(folder_.write("task.toml", with(term)), test::test_search(), {}, own);
  }
  std::string said(const std::string& term, const OwnTerms& own = {}) {
    return test::message_of(folder_.path(), [&] { read_own(term, own); });
  }
};

TEST_F(OwnTaskTerms, AreFoundByTheirNames) {
  const Task task = read_own("own = \"height\"\nvalue = [\"free\", \"free\", [0.2, 0.9]]\n");
  EXPECT_EQ(task.problem.terms.at(0).term, task.own_terms.known.at("height"));
  EXPECT_EQ(task.problem.terms.at(0).lower(2), 0.2);
  EXPECT_TRUE(read_own("own = \"height\"\nvalue = [0, 0, 0]\nweight = 1\n").problem.terms.at(0).is_cost());
}

TEST_F(OwnTaskTerms, SayWhatIsWrong) {
  EXPECT_THAT(said("own = \"hight\"\nvalue = [0, 0, 0]\n"), HasSubstr("did you mean 'height'"));
  EXPECT_THAT(message_of(with("own = \"height\"\nvalue = [0, 0, 0]\n")), HasSubstr("no term 'height' is known"));
  EXPECT_THAT(said("own = \"height\"\n"), HasSubstr("value"));
  EXPECT_THAT(said("own = \"height\"\nvalue = [0]\n"), HasSubstr("value: 1 entries are not allowed; need 3: x, y, z"));
  EXPECT_THAT(said("own = \"height\"\nvalue = [0, 0, 0]\ncom_m = [0, 0, 0]\n"), HasSubstr("com_m is here, too"));
  EXPECT_THAT(said("com_m = [0, 0, \"free\"]\nvalue = [0]\n"), HasSubstr("has no meaning beside com_m"));
  const std::string library = "own = \"height\"\nvalue = [0, 0, 0]\nlibrary = \"libnone.so\"\n";
  EXPECT_THAT(said(library), HasSubstr("a library is not loaded by default; need --allow-libraries"));
  EXPECT_THAT(said(library, {.known = {}, .allows_libraries = true}),
              testing::AllOf(HasSubstr("library: "), HasSubstr("libnone.so: no library of terms"),
                             HasSubstr("cannot open shared object file")));
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
