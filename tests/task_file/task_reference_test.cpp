#include <gmock/gmock.h>

#include "prowl/task_file/reference_csv.hpp"
#include "tests/support/reference_csv.hpp"
#include "tests/support/task_test.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

class TaskReference : public test::TaskTest {
 protected:
  void SetUp() override { folder_.write("motion.csv", test::reference_csv({0.0, 0.5, 1.0})); }
  std::string with(const std::string& keys) const { return test::kTaskFile + ("\n[reference]\n" + keys); }
  /// What is said about a CSV file.
  std::string said_about(const std::string& csv) {
    folder_.write("motion.csv", csv);
    return message_of(with("file = \"motion.csv\"\njoint_position = 1\n"));
  }
};

TEST_F(TaskReference, IsACostToTheMotionInTheFile) {
  const Task task =
      read(with("file = \"motion.csv\"\nbase_position = [1, 2, 3]\njoint_position = 4\n"
                "[[reference.frame]]\nframe = \"lf_foot\"\nweight = 5\n"));
  ASSERT_EQ(task.problem.terms.size(), 3u);
  EXPECT_EQ(task.problem.terms[0].weight.diagonal(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(task.problem.terms[2].weight.diagonal(), Eigen::Vector3d(5.0, 5.0, 5.0));
  ASSERT_TRUE(task.problem.reference);
  EXPECT_EQ(task.problem.reference->times, Eigen::Vector3d(0.0, 0.5, 1.0));
  ASSERT_TRUE(task.reference_file);
  EXPECT_EQ(task.reference_file->path, folder_.path() / "motion.csv");
}

TEST_F(TaskReference, TimesCountFromTheFirstRowAndTheLastRowOfATimeCounts) {
  const Task task = read(with("file = \"motion.csv\"\njoint_position = 1\n"));
  const ReferenceMotion reference =
      read_reference_csv(task.problem.robot, {"other.csv", test::reference_csv({2.0, 2.0, 2.5, 2.5, 3.0})});
  EXPECT_EQ(reference.times, Eigen::Vector3d(0.0, 0.5, 1.0));
  EXPECT_EQ(reference.q(0, 1), 3.0) << "the x of the fourth row, test::reference_csv() counts";
}

TEST_F(TaskReference, MistakesAreToldWithTheirPlace) {
  EXPECT_THAT(message_of(with("file = \"none.csv\"\njoint_position = 1\n")), HasSubstr("reference.file: "));
  EXPECT_THAT(message_of(with("file = \"motion.csv\"\n")), HasSubstr("reference: weighs nothing"));
  EXPECT_THAT(message_of(with("file = \"motion.csv\"\n[[reference.frame]]\nframe = \"lf_fot\"\nweight = 5\n")),
              HasSubstr("reference.frame[0].frame: "));
  EXPECT_THAT(message_of("robot = \"hyq.toml\"\n[[phase]]\ncontacts = \"all\"\nduration_s = [0.5, 1]\n"
                         "[reference]\nfile = \"motion.csv\"\njoint_position = 1\n"),
              HasSubstr("phase 'phase 1' has a free duration, which shifts the reference"));
  const std::string good = test::reference_csv({0.0, 0.5, 1.0});
  EXPECT_THAT(said_about(test::reference_csv({0.0, 0.5, 0.4})), HasSubstr("motion.csv:4: time_s: 0.4 is not allowed"));
  EXPECT_THAT(said_about(test::replaced(good, "\n0.5,", "\nnan,")), HasSubstr("motion.csv:3: time_s: nan"));
  EXPECT_THAT(said_about(test::replaced(good, "base_qw", "base_w")), HasSubstr("no column base_qw"));
  EXPECT_THAT(said_about(test::replaced(good, "q_rh_kfe_joint_rad", "other")),
              HasSubstr("no column q_rh_kfe_joint_rad"));
  EXPECT_THAT(said_about(test::replaced(good, "\n0,0,0,0.6,0,0,0,1,", "\n0,0,0,0.6,0,0,0,1.1,")),
              HasSubstr("motion.csv:2: length of base_qx ... base_qw: 1.1 is not allowed"));
  EXPECT_THAT(said_about(test::replaced(good, "\n0,0,0,0.6,0,0,0,1,", "\n0,0,0,0.6,0,0,inf,1,")),
              HasSubstr("motion.csv:2: base_qz: inf"));
  EXPECT_THAT(said_about(good.substr(0, good.find('\n') + 1)), HasSubstr("no rows"));
}

}  // namespace
}  // namespace prowl
