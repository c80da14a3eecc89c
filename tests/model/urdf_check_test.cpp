#include "prowl/model/urdf/urdf_check.hpp"

#include <gmock/gmock.h>

#include "prowl/error.hpp"
#include "tests/support/small_robot.hpp"

namespace prowl {
namespace {

using test::replaced;
using test::small_urdf;

std::string message_for(const std::string& xml) {
  try {
    check_urdf("robot.urdf", xml);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(UrdfCheck, AcceptsASoundRobotAndReportsItsInertias) {
  const std::vector<UrdfLink> links = check_urdf("robot.urdf", small_urdf()).links;
  ASSERT_EQ(links.size(), 3u);  // the feet have none
  EXPECT_EQ(links[1].name, "left_leg");
  EXPECT_EQ(links[1].mass, 1.0);
  EXPECT_EQ(links[0].inertia.diagonal(), Eigen::Vector3d(0.2, 0.3, 0.4));
}

TEST(UrdfCheck, TakesShapesThatItCannotUse) {
  for (const char* shape : {"<teapot/>", "", "<mesh filename=\"package://nowhere/x.stl\" scale=\"1 -1 1\"/>",
                            "<plane normal=\"0 0 1\"/>", "<box size=\"0 0 0\"/>"}) {
    const std::string link =
        std::string("<link name=\"left_foot\"><visual><geometry>") + shape + "</geometry></visual></link>";
    EXPECT_EQ(message_for(replaced(small_urdf(), "<link name=\"left_foot\"/>", link)), "accepted") << shape;
  }
}

TEST(UrdfCheck, RefusesShapesWithoutSense) {
  const auto message = [](const std::string& visual) {
    return message_for(replaced(small_urdf(), "<link name=\"left_foot\"/>",
                                "<link name=\"left_foot\"><visual>" + visual + "</visual></link>"));
  };
  for (const char* shape :
       {"<box size=\"nan 1 1\"/>", "<box size=\"1 1\"/>", "<box size=\"1 -1 1\"/>", "<box/>", "<sphere radius=\"-1\"/>",
        "<sphere/>", "<cylinder radius=\"1\"/>", "<capsule radius=\"1\" length=\"inf\"/>", "<mesh/>",
        "<mesh filename=\"x\" scale=\"1 1\"/>"}) {
    EXPECT_THAT(message(std::string("<geometry>") + shape + "</geometry>"), testing::HasSubstr("link 'left_foot': <"))
        << shape;
  }
  EXPECT_THAT(message("<origin xyz=\"0 nan 0\"/>"), testing::HasSubstr("link 'left_foot': <origin xyz"));
  EXPECT_THAT(message("<material name=\"m\"><color rgba=\"1 0 0\"/></material>"),
              testing::HasSubstr("four finite numbers"));
}

TEST(UrdfCheck, RefusesEntities) {
  const std::string bomb = "<!DOCTYPE r [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]>";
  EXPECT_THAT(message_for(replaced(small_urdf(), "<robot", bomb + "<robot")),
              testing::HasSubstr("robot.urdf:2: entities"));
  EXPECT_EQ(message_for(replaced(small_urdf(), "<robot", "<!DOCTYPE robot><robot")), "accepted");
}

TEST(UrdfCheck, RefusesPinocchiosNameOfTheWorld) {
  std::string urdf = small_urdf();
  for (int i = 0; i < 3; ++i) urdf = replaced(urdf, "\"base\"", "\"universe\"");
  EXPECT_THAT(message_for(urdf), testing::HasSubstr("robot.urdf:3: link 'universe': Pinocchio uses this name"));
}

TEST(UrdfCheck, CutsWhatItQuotes) {
  const auto message = [](const std::string& mass) {
    return message_for(replaced(small_urdf(), "mass value=\"1\"", "mass value=\"" + mass + "\""));
  };
  const std::string cut = message(std::string(1000000, '1'));
  EXPECT_LT(cut.size(), 400u);
  EXPECT_THAT(cut, testing::AllOf(testing::HasSubstr("link 'left_leg'"), testing::HasSubstr("(1000000 bytes)"),
                                  testing::HasSubstr("finite")));
  EXPECT_THAT(message("\x1b[2J"), testing::HasSubstr("\"\\x1b[2J\""));
}

/// One damage to the sound robot, and what the message must say: the element, the value, what is expected.
struct Damage {
  const char* name;
  const char* from;
  const char* to;
  std::vector<std::string> said;
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

class UrdfDamage : public testing::TestWithParam<Damage> {};

TEST_P(UrdfDamage, IsRefusedWithFileElementValueAndRemedy) {
  const Damage& damage = GetParam();
  const std::string message = message_for(replaced(small_urdf(), damage.from, damage.to));
  EXPECT_THAT(message, testing::StartsWith("robot.urdf:"));
  for (const std::string& part : damage.said) EXPECT_THAT(message, testing::HasSubstr(part));
}

INSTANTIATE_TEST_SUITE_P(
    Numbers, UrdfDamage,
    testing::Values(
        Damage{"mass_nan", "mass value=\"1\"", "mass value=\"nan\"", {":13:", "link 'left_leg'", "\"nan\"", "number"}},
        Damage{"mass_inf", "mass value=\"1\"", "mass value=\"inf\"", {"link 'left_leg'", "\"inf\"", "finite"}},
        Damage{"mass_comma", "mass value=\"1\"", "mass value=\"1,5\"", {"link 'left_leg'", "\"1,5\"", "like 1.5"}},
        Damage{"mass_unit", "mass value=\"1\"", "mass value=\"1.5kg\"", {"\"1.5kg\"", "no unit"}},
        Damage{"mass_two", "mass value=\"1\"", "mass value=\"1 5\"", {"\"1 5\"", "one finite number"}},
        Damage{"mass_empty", "mass value=\"1\"", "mass value=\"\"", {"link 'left_leg'", "value"}},
        Damage{"mass_negative", "mass value=\"1\"", "mass value=\"-1\"", {"link 'left_leg'", "\"-1\"", ">= 0"}},
        Damage{"mass_huge", "mass value=\"1\"", "mass value=\"1e308\"", {"link 'left_leg'", "1e308"}},
        Damage{"inertia_nan", "ixx=\"0.02\"", "ixx=\"nan\"", {"link 'left_leg'", "ixx=\"nan\""}},
        Damage{"inertia_missing", "ixx=\"0.02\"", "", {"link 'left_leg'", "no ixx"}},
        Damage{"no_mass", "<mass value=\"1\"/>", "", {"link 'left_leg'", "both <mass> and <inertia>"}},
        Damage{"origin_huge", "xyz=\"0 0.1 0\"", "xyz=\"0 1e308 0\"", {"joint 'left_hip'", "1e308", "three finite"}},
        Damage{"origin_two", "xyz=\"0 0.1 0\"", "xyz=\"0 0.1\"", {"joint 'left_hip'", "\"0 0.1\"", "three"}},
        Damage{"origin_four", "xyz=\"0 0.1 0\"", "xyz=\"0 0.1 0 0\"", {"joint 'left_hip'", "three"}},
        Damage{"effort_nan", "effort=\"50\"", "effort=\"nan\"", {"joint 'left_hip'", "effort=\"nan\""}},
        Damage{"effort_missing", "effort=\"50\"", "", {"joint 'left_hip'", "no effort"}},
        Damage{"lower_text", "lower=\"-0.5\"", "lower=\"low\"", {"joint 'left_hip'", "lower=\"low\""}}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Joints, UrdfDamage,
    testing::Values(
        Damage{"axis_zero", "axis xyz=\"1 0 0\"", "axis xyz=\"0 0 0\"", {"joint 'left_hip'", "0 0 0", "direction"}},
        Damage{"axis_nan", "axis xyz=\"1 0 0\"", "axis xyz=\"nan 0 0\"", {"joint 'left_hip'", "nan 0 0"}},
        Damage{"no_limit",
               "<limit lower=\"-0.5\" upper=\"1.5\" velocity=\"10\" effort=\"50\"/>",
               "",
               {"joint 'left_hip'", "no <limit>"}},
        Damage{"negative_damping",
               "effort=\"50\"/>",
               "effort=\"50\"/><dynamics damping=\"-0.1\"/>",
               {"joint 'left_hip'", "damping=\"-0.1\"", "expected a number >= 0"}},
        Damage{"friction_nan",
               "effort=\"50\"/>",
               "effort=\"50\"/><dynamics friction=\"nan\"/>",
               {"joint 'left_hip'", "friction"}},
        Damage{"continuous",
               "type=\"revolute\"",
               "type=\"continuous\"",
               {"joint 'left_hip'", "continuous", "limits", "type=\"revolute\""}},
        Damage{"floating", "type=\"revolute\"", "type=\"floating\"", {"joint 'left_hip'", "floating", "remove"}},
        Damage{"planar", "type=\"revolute\"", "type=\"planar\"", {"joint 'left_hip'", "planar", "prismatic"}},
        Damage{
            "unknown_type", "type=\"revolute\"", "type=\"hinge\"", {"joint 'left_hip'", "hinge", "expected revolute"}},
        Damage{"no_type", "type=\"revolute\"", "", {"joint 'left_hip'", "type"}}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Tree, UrdfDamage,
    testing::Values(
        Damage{"unknown_parent",
               "parent link=\"base\"",
               "parent link=\"bass\"",
               {"joint 'left_hip'", "'bass' does not exist", "did you mean 'base'"}},
        Damage{"no_child", "<child link=\"left_leg\"/>", "", {"joint 'left_hip'", "<child"}},
        Damage{"two_parents",
               "child link=\"left_foot\"",
               "child link=\"right_leg\"",
               {"'left_ankle'", "'right_leg' is already"}},
        Damage{"two_roots",
               "<joint name=\"left_ankle\" type=\"fixed\">\n    <parent link=\"left_leg\"/>\n    <child "
               "link=\"left_foot\"/>\n    <origin xyz=\"0 0 -0.5\"/>\n  </joint>",
               "",
               {"robot 'small'", "2 links", "left_foot", "exactly one"}},
        Damage{"loop",
               "<parent link=\"base\"/>\n    <child link=\"left_leg\"/>",
               "<parent link=\"left_foot\"/>\n    <child link=\"left_leg\"/>",
               {"robot 'small'", "loop"}},
        Damage{"same_link",
               "link name=\"right_foot\"",
               "link name=\"left_foot\"",
               {"link 'left_foot'", "already used in line", "unique"}},
        Damage{"same_joint", "joint name=\"right_hip\"", "joint name=\"left_hip\"", {"joint 'left_hip'", "unique"}},
        Damage{"not_closed", "</robot>", "", {"not an XML file"}},
        Damage{"sdf", "<robot name=\"small\">", "<sdf version=\"1.6\"/><robot name=\"small\">", {"not a URDF"}},
        Damage{"no_name", "<robot name=\"small\">", "<robot>", {"name"}},
        Damage{"xacro", "<link name=\"base\">", "<xacro:macro name=\"leg\"/><link name=\"base\">", {"xacro", ":3:"}}),
    [](const auto& info) { return info.param.name; });

TEST(UrdfCheck, RefusesWhatIsNoXml) {
  EXPECT_THAT(message_for(""), testing::HasSubstr("not an XML file"));
  EXPECT_THAT(message_for("name = \"HyQ\""), testing::HasSubstr("not an XML file"));
  EXPECT_THAT(message_for("<robot name=\"empty\"/>"), testing::HasSubstr("no <link>"));
}

TEST(UrdfCheck, RefusesXmlWithoutAnElement) {
  EXPECT_THAT(message_for("<!-- to do -->\n"), testing::HasSubstr("robot.urdf:1: no XML element"));
  EXPECT_THAT(message_for("<?xml version=\"1.0\"?>\n"), testing::HasSubstr("no XML element"));
}

TEST(UrdfCheck, RefusesNamesThatBreakFilesAndMessages) {
  for (const char* name : {"left,foot", "left\nfoot", "left&quot;foot", "left\xff_foot", "left_foot ", "\x1b[2J"}) {
    const std::string xml =
        replaced(small_urdf(), "link name=\"left_foot\"", std::string("link name=\"") + name + "\"");
    EXPECT_THAT(message_for(xml), testing::AllOf(testing::StartsWith("robot.urdf:"), testing::HasSubstr("of a link")))
        << name;
  }
  EXPECT_THAT(message_for(replaced(small_urdf(), "joint name=\"left_hip\"", "joint name=\"left,hip\"")),
              testing::HasSubstr("of a joint is not allowed"));
}

TEST(UrdfCheck, RefusesMoreJointsThanTheMemoryIsFor) {
  EXPECT_EQ(message_for(test::chain_urdf(120)), "accepted");
  EXPECT_THAT(message_for(test::chain_urdf(121)), testing::HasSubstr("joint 'j121': more than 120 moving joints"));
}

TEST(UrdfCheck, RefusesAChainTooLongToBeARobot) {
  std::string xml = "<robot name=\"chain\">";
  for (int i = 0; i < 3000; ++i) xml += "<link name=\"l" + std::to_string(i) + "\"/>";
  EXPECT_THAT(message_for(xml + "</robot>"), testing::HasSubstr("more than 1000 links"));
}

TEST(UrdfCheck, FindsJointsThatCopyOthers) {
  const std::string axis = "<axis xyz=\"1 0 0\"/>";
  const std::string xml = replaced(small_urdf(), axis, axis + "<mimic joint=\"right_hip\"/>");
  EXPECT_EQ(check_urdf("robot.urdf", xml).mimics, std::vector<std::string>{"left_hip"});
}

TEST(UrdfCheck, TakesAContinuousJointThatIsLocked) {
  const std::string xml = replaced(small_urdf(), "type=\"revolute\"", "type=\"continuous\"");
  EXPECT_NO_THROW(check_urdf("robot.urdf", xml, {"left_hip"}));
}

TEST(UrdfCheck, LeavesFixedJointsAlone) {
  // Real files carry limits, zero axes and mimics of the moving joint that a fixed one once was.
  const std::string fixed = "<child link=\"left_foot\"/>";
  EXPECT_EQ(message_for(replaced(small_urdf(), fixed, fixed + "<axis xyz=\"0 0 0\"/><mimic joint=\"left_hip\"/>")),
            "accepted");
}

}  // namespace
}  // namespace prowl
