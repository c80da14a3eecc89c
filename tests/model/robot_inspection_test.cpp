#include "prowl/model/robot_inspection.hpp"

#include <gmock/gmock.h>

#include "tests/support/robots.hpp"
#include "tests/support/small_robot.hpp"

namespace prowl {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = RobotWarning::Kind;

std::vector<std::string> texts(const RobotInspection& inspection, Kind kind) {
  std::vector<std::string> result;
  for (const RobotWarning& warning : inspection.warnings) {
    if (warning.kind == kind) result.push_back(warning.text);
  }
  return result;
}

std::vector<std::string> all_texts(const RobotInspection& inspection) {
  std::vector<std::string> result;
  for (const RobotWarning& warning : inspection.warnings) result.push_back(warning.text);
  return result;
}

/// The small robot, with one change to its URDF.
RobotInspection inspect_changed(const std::string& from, const std::string& to) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("small.urdf", test::replaced(test::small_urdf(), from, to));
  return inspect(RobotModel(test::small_description(file)));
}

TEST(RobotInspection, ASoundRobotGivesNoWarning) {
  EXPECT_THAT(all_texts(inspect_changed("name=\"small\"", "name=\"sound\"")), IsEmpty());
}

TEST(RobotInspection, NamesJointsThatMoveNoInertiaOrCopyOthers) {
  EXPECT_THAT(texts(inspect_changed("izz=\"0.001\"", "izz=\"0\""), Kind::inertia),
              Contains("joints that move a body without an inertia of its own, and others beyond it: left_hip"));
  RobotDescription robot = test::small_description("/nowhere/small.urdf");
  robot.contacts.erase(robot.contacts.begin());
  robot.urdf_text =
      test::replaced(test::small_urdf(), "<axis xyz=\"1 0 0\"/>", "<axis xyz=\"1 0 0\"/><mimic joint=\"right_hip\"/>");
  EXPECT_THAT(texts(inspect(RobotModel(robot)), Kind::mimic),
              ElementsAre("joints that copy others are locked: left_hip"));
}

TEST(RobotInspection, PointFeetHaveFullRankAndFlatFeetHaveNot) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2()}) {
    const RobotInspection inspection = inspect(robot);
    EXPECT_EQ(inspection.contact_rows, 12) << robot.name();
    EXPECT_EQ(inspection.contact_rank, 12) << robot.name();
  }
  const RobotInspection talos = inspect(test::talos());
  EXPECT_EQ(talos.contact_rows, 24);
  EXPECT_EQ(talos.contact_rank, 12);
  EXPECT_EQ(talos.contact_singular_values.size(), 24);
}

TEST(RobotInspection, SingularValuesAreThoseOfAllContactsTogether) {
  // |J|_F^2 is the sum of their squares; the base translations alone give 1 for each of the 12 rows.
  const Eigen::VectorXd values = inspect(test::hyq()).contact_singular_values;
  EXPECT_GT(values.squaredNorm(), 12.0);
  EXPECT_GE(values(0), 2.0);  // moving the base moves four feet: |J v| = 2 |v|
  EXPECT_TRUE(std::is_sorted(values.begin(), values.end(), std::greater<>{}));
}

TEST(RobotInspection, NamesWhatIsKnownToBeOddInTheTestRobots) {
  EXPECT_THAT(texts(inspect(test::hyq()), Kind::inertia),
              testing::UnorderedElementsAre(HasSubstr("almost no mass: base_link 1e-06 kg, lf_foot"),
                                            HasSubstr("link 'trunk_imu': the principal moments")));

  RobotDescription anymal = test::anymal_c_description();
  anymal.limits.clear();  // as the URDF says: hips and knees may turn by +-9.42 rad
  EXPECT_THAT(texts(inspect(RobotModel(anymal)), Kind::limit),
              ElementsAre(HasSubstr("position range beyond +-2 pi rad (or +-1000 m) is no limit: LF_HFE, LF_KFE")));
  RobotDescription solo = test::solo12_description();
  solo.limits.clear();  // as the URDF says: 1000 N m, 1000 rad/s, +-10 rad
  const auto limits = texts(inspect(RobotModel(solo)), Kind::limit);
  EXPECT_THAT(limits, ElementsAre(HasSubstr("torque limit of 1000"), HasSubstr("velocity limit of 1000"),
                                  HasSubstr("position range beyond")));
  EXPECT_THAT(limits[0], HasSubstr("FL_HAA, FL_HFE"));
}

TEST(RobotInspection, TheLimitsOfTheRobotFilesAreReal) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2(), test::talos()}) {
    EXPECT_THAT(texts(inspect(robot), Kind::limit), IsEmpty()) << robot.name();
    EXPECT_THAT(texts(inspect(robot), Kind::posture), IsEmpty()) << robot.name();
    EXPECT_THAT(texts(inspect(robot), Kind::ground), IsEmpty()) << robot.name();
    EXPECT_THAT(texts(inspect(robot), Kind::symmetry), IsEmpty()) << robot.name();
  }
}

TEST(RobotInspection, WarnsOfOneWrongNumberInTheUrdf) {
  EXPECT_THAT(texts(inspect_changed("upper=\"1.5\"", "upper=\"15\""), Kind::limit), ElementsAre(HasSubstr("left_hip")));
  EXPECT_THAT(texts(inspect_changed("upper=\"1.5\"", "upper=\"1.2\""), Kind::symmetry),
              ElementsAre(HasSubstr("'left_hip' and 'right_hip' differ in position range: -0.5 to 1.2")));
  EXPECT_THAT(texts(inspect_changed("effort=\"50\"", "effort=\"40\""), Kind::symmetry),
              ElementsAre(HasSubstr("torque limit: 40 and 50")));
  EXPECT_THAT(texts(inspect_changed("velocity=\"10\"", "velocity=\"9\""), Kind::symmetry),
              ElementsAre(HasSubstr("velocity limit: 9 and 10")));
  EXPECT_THAT(texts(inspect_changed("mass value=\"1\"", "mass value=\"1.1\""), Kind::symmetry),
              ElementsAre(HasSubstr("mass they move: 1.1 and 1 kg")));
  EXPECT_THAT(texts(inspect_changed("<link name=\"left_foot\"/>",
                                    "<link name=\"left_foot\"><inertial><mass value=\"0.001\"/><inertia ixx=\"1e-7\" "
                                    "ixy=\"0\" ixz=\"0\" iyy=\"1e-7\" iyz=\"0\" izz=\"1e-6\"/></inertial></link>"),
                    Kind::inertia),
              ElementsAre(testing::AllOf(HasSubstr("link 'left_foot'"), HasSubstr("triangle inequality"))));
  EXPECT_THAT(texts(inspect_changed("<link name=\"left_foot\"/>",
                                    "<link name=\"left_foot\"><inertial><mass value=\"1e-6\"/><inertia ixx=\"1e-9\" "
                                    "ixy=\"0\" ixz=\"0\" iyy=\"1e-9\" iyz=\"0\" izz=\"1e-9\"/></inertial></link>"),
                    Kind::inertia),
              ElementsAre(HasSubstr("almost no mass: left_foot 1e-06 kg")));
}

TEST(RobotInspection, WarnsOfALongerLegTwice) {
  const RobotInspection longer = inspect_changed("origin xyz=\"0 0 -0.5\"", "origin xyz=\"0 0 -0.505\"");
  EXPECT_THAT(texts(longer, Kind::ground), ElementsAre(HasSubstr("left_foot 0.0 mm, right_foot 5.0 mm")));
  EXPECT_THAT(texts(longer, Kind::symmetry), ElementsAre(HasSubstr("5.0 mm apart")));
}

TEST(RobotInspection, WarnsOfMillimetresAndGrams) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2(), test::talos()}) {
    EXPECT_THAT(implausible_sizes(robot), IsEmpty()) << robot.name();
  }
  RobotDescription hyq = test::hyq_description();
  hyq.contacts[1].radius = 21.75;
  EXPECT_THAT(texts(inspect(RobotModel(hyq)), Kind::size),
              Contains(AllOf(HasSubstr("'lh_foot'"), HasSubstr("radius of 21.8 m"), HasSubstr("metres?"))));
  RobotDescription grams = test::small_description("/nowhere/small.urdf");
  grams.urdf_text = test::replaced(test::small_urdf(), "mass value=\"10\"", "mass value=\"10000\"");
  EXPECT_THAT(implausible_sizes(RobotModel(grams)), ElementsAre(HasSubstr("in kilograms and metres?")));
}

TEST(RobotInspection, WarnsOfPosturesThatLeanOrPassTheLimits) {
  RobotDescription robot = test::hyq_description();
  robot.nominal_joints["lf_haa_joint"] = 0.2;  // mirrored feet need the same sign as rf_haa_joint
  EXPECT_THAT(texts(inspect(RobotModel(robot)), Kind::symmetry), ElementsAre(HasSubstr("'lf_foot' and the mirror")));

  robot = test::hyq_description();
  robot.nominal_joints["lh_kfe_joint"] = -1.5;
  EXPECT_THAT(texts(inspect(RobotModel(robot)), Kind::posture), ElementsAre(HasSubstr("limits: lh_kfe_joint")));
}

TEST(RobotInspection, WarnsOfContactPointsTooCloseToTellApart) {
  RobotDescription robot = test::hyq_description();
  robot.contacts.push_back({"lf_foot_too", "lf_foot", 0.02175, {1e-9, 0.0, 0.0}});
  EXPECT_THAT(texts(inspect(RobotModel(robot)), Kind::contacts),
              AllOf(Contains("contacts 'lf_foot' and 'lf_foot_too' are one point"), Contains(HasSubstr("ambiguous"))));
  EXPECT_THAT(texts(inspect(test::hyq()), Kind::contacts), IsEmpty());
}

/// Two points of one foot at distance d leave a singular value of about d. Between 1e-10 and 1e-6 of the largest one,
/// the rank is a choice.
TEST(RobotInspection, WarnsOfARankThatIsAmbiguous) {
  const auto is_ambiguous = [](double d) {
    RobotDescription robot = test::hyq_description();
    robot.contacts.push_back({"lf_foot_too", "lf_foot", 0.02175, {d, 0.0, 0.0}});
    const std::vector<std::string> found = texts(inspect(RobotModel(robot)), Kind::contacts);
    return std::ranges::any_of(found, [](const std::string& text) { return text.find("ambiguous") != text.npos; });
  };
  for (const double d : {1e-7, 1e-8, 1e-9}) EXPECT_TRUE(is_ambiguous(d)) << d;
  for (const double d : {0.1, 1e-4, 1e-12, 0.0}) EXPECT_FALSE(is_ambiguous(d)) << d;
}

}  // namespace
}  // namespace prowl
