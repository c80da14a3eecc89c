// prowl new robot and new task, on the URDFs of the wheels: what they write is read, and is what a person wrote by
// hand.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/Core>
#include <algorithm>
#include <set>

#include "command.hpp"

namespace prowl {
namespace {

using nlohmann::json;
using test::Command;
using test::Outcome;
using testing::HasSubstr;
using testing::Not;

struct Urdf {
  const char* name;
  const char* path;
  int feet;  ///< legs with a foot
  int contacts;
  const char* shipped;  ///< in robots/; "" if Prowl has none
};

void PrintTo(const Urdf& urdf, std::ostream* stream) { *stream << urdf.name; }

// All legged URDFs of example-robot-data that Prowl takes: docs/adding-a-robot.md has the others, and why.
const Urdf kUrdfs[] = {
    {"hyq", "hyq_description/robots/hyq_no_sensors.urdf", 4, 4, "hyq.toml"},
    {"anymal_c", "anymal_c_simple_description/urdf/anymal.urdf", 4, 4, "anymal_c.toml"},
    {"go2", "go2_description/urdf/go2.urdf", 4, 4, "go2.toml"},
    {"solo12", "solo_description/robots/solo12.urdf", 4, 4, "solo12.toml"},
    {"talos", "talos_data/robots/talos_reduced.urdf", 2, 8, "talos.toml"},
    {"laikago", "laikago_description/urdf/laikago.urdf", 4, 4, ""},
    {"a1", "a1_description/urdf/a1.urdf", 4, 4, ""},
    {"go1", "go1_description/urdf/go1.urdf", 4, 4, ""},
    {"b1", "b1_description/urdf/b1.urdf", 4, 4, ""},
    {"b1_z1", "b1_description/urdf/b1-z1.urdf", 4, 4, ""},
    {"anymal_b", "anymal_b_simple_description/robots/anymal.urdf", 4, 4, ""},
    {"anymal_b_kinova", "anymal_b_simple_description/robots/anymal-kinova.urdf", 4, 4, ""},
    {"solo", "solo_description/robots/solo.urdf", 4, 4, ""},
    {"quadruped", "quadruped_description/urdf/quadruped.urdf", 4, 4, ""},
    {"centauro", "centauro_description/urdf/centauro.urdf", 4, 4, ""},
    {"bolt", "bolt_description/robots/bolt.urdf", 2, 2, ""},
    {"talos_box", "talos_data/robots/talos_reduced_box.urdf", 2, 8, ""},
    {"g1", "g1_description/urdf/g1_29dof_rev_1_0.urdf", 2, 8, ""},
    {"alexander", "alexander_description/urdf/alexander_v1.lowerBodyOnly.urdf", 2, 8, ""},
    {"simple_humanoid", "simple_humanoid_description/urdf/simple_humanoid.urdf", 2, 2, ""},
};

const std::string kData = PROWL_ROBOTS_DATA "/example-robot-data/robots/";

class NewRobot : public Command {
 protected:
  Outcome make(const std::string& urdf, const std::string& out, const std::string& options = "") const {
    return run("$prowl new robot '" + kData + urdf + "' $dirs --out " + out + " " + options);
  }
  json inspected(const std::string& file) const {
    const Outcome result = run("$prowl robot '" + file + "' $dirs --json");
    EXPECT_EQ(result.status, 0) << result.error;
    return json::parse(result.out);
  }
};

class EachUrdf : public NewRobot, public testing::WithParamInterface<Urdf> {};

TEST_P(EachUrdf, GivesARobotThatStandsOnItsFeet) {
  const Outcome made = make(GetParam().path, "new.toml");
  ASSERT_EQ(made.status, 0) << made.error;
  EXPECT_THAT(made.out, HasSubstr("standing with the base"));
  const json robot = inspected("new.toml");
  EXPECT_EQ(robot.at("contacts").size(), static_cast<std::size_t>(GetParam().contacts));
  std::set<std::string> frames;
  for (const json& contact : robot.at("contacts")) frames.insert(contact.at("frame"));
  EXPECT_EQ(frames.size(), static_cast<std::size_t>(GetParam().feet));
  for (const json& warning : robot.at("warnings")) {
    EXPECT_THAT(warning.get<std::string>(), Not(HasSubstr("not level")));
    EXPECT_THAT(warning.get<std::string>(), Not(HasSubstr("outside the joint limits")));
  }
  EXPECT_GT(robot.at("nominal_configuration").at(2), 0.1) << "the base lies on the ground";
}

INSTANTIATE_TEST_SUITE_P(Urdfs, EachUrdf, testing::ValuesIn(kUrdfs),
                         [](const auto& info) { return std::string(info.param.name); });

Eigen::Vector3d offset_of(const json& contact) {
  const auto offset = contact.at("offset_m").get<std::vector<double>>();
  return {offset[0], offset[1], offset[2]};
}

class EachShippedRobot : public NewRobot, public testing::WithParamInterface<Urdf> {};

TEST_P(EachShippedRobot, HasTheFeetThatWereFoundByHand) {
  ASSERT_EQ(make(GetParam().path, "new.toml").status, 0);
  const json by_hand = inspected(PROWL_SOURCE_DIR "/robots/" + std::string(GetParam().shipped)).at("contacts");
  const json found = inspected("new.toml").at("contacts");
  ASSERT_EQ(found.size(), by_hand.size());
  // A sole's corners: nobody knows them to the millimetre.
  const double close = GetParam().contacts > GetParam().feet ? 0.01 : 0.001;
  for (const json& contact : by_hand) {
    const bool is_there = std::any_of(found.begin(), found.end(), [&](const json& other) {
      return other.at("frame") == contact.at("frame") &&
             std::abs(other.at("radius_m").get<double>() - contact.at("radius_m").get<double>()) < 0.001 &&
             (offset_of(other) - offset_of(contact)).norm() < close;
    });
    EXPECT_TRUE(is_there) << contact << " is not in " << found;
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, EachShippedRobot, testing::ValuesIn(std::begin(kUrdfs), std::begin(kUrdfs) + 5),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_F(NewRobot, SaysWhatItGuessed) {
  ASSERT_EQ(make(kUrdfs[3].path, "solo.toml").status, 0);
  const std::string text = test::read_file(folder_.path() / "solo.toml");
  for (const char* part :
       {"Contacts, guess", "Start posture of motions, guess", "# guess: 0.1 to 2.6 rad from straight",
        "1000 N m or more is no limit", "package://example-robot-data/robots/solo_description/robots/solo12.urdf"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST_F(NewRobot, FindsAUrdfOfNoPackageBesideTheFile) {
  folder_.write("robot.urdf", test::read_file(kData + kUrdfs[5].path));
  const Outcome made = run("mkdir robots; $prowl new robot robot.urdf --out robots/new.toml");
  ASSERT_EQ(made.status, 0) << made.error;
  EXPECT_THAT(test::read_file(folder_.path() / "robots/new.toml"), HasSubstr("urdf = \"../robot.urdf\""));
  EXPECT_EQ(run("cd robots; $prowl robot new.toml").status, 0);
}

TEST_F(NewRobot, TakesNoNameForText) {
  // A robot, a mesh and a folder whose names would end a string or a comment of the file.
  std::string urdf = test::read_file(kData + kUrdfs[5].path);
  const auto replace = [&urdf](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = urdf.find(from, at)) != std::string::npos; at += to.size())
      urdf.replace(at, from.size(), to);
  };
  replace("name=\"laikago\"", "name='a \"quoted\" name'");
  replace("<sphere radius=\"0.0265\"/>", "<mesh filename=\"no&#10;[[such]]&#10;mesh.stl\"/>");
  folder_.write("of \"it\"/robot.urdf", urdf);
  const Outcome made = run("$prowl new robot 'of \"it\"/robot.urdf' --out new.toml");
  ASSERT_EQ(made.status, 0) << made.error;
  EXPECT_EQ(inspected("new.toml").at("name"), "robot");
  const std::string text = test::read_file(folder_.path() / "new.toml");
  EXPECT_THAT(text, HasSubstr("Unreadable mesh: "));
  EXPECT_THAT(text, Not(HasSubstr("\n[[such]]")));
}

TEST_F(NewRobot, ReplacesAFileOnlyWhenTold) {
  folder_.write("mine.toml", "mine");
  const Outcome refused = make(kUrdfs[2].path, "mine.toml");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.error, HasSubstr("--force"));
  EXPECT_EQ(test::read_file(folder_.path() / "mine.toml"), "mine");
  EXPECT_EQ(make(kUrdfs[2].path, "mine.toml", "--force").status, 0);
  EXPECT_EQ(run("$prowl robot mine.toml $dirs").status, 0);
  EXPECT_EQ(run("$prowl new task mine.toml $dirs --out mine.toml").status, 2);
}

TEST_F(NewRobot, IsCalledAsItsMakerCallsIt) {
  ASSERT_EQ(make("b1_description/urdf/b1.urdf", "new.toml").status, 0);
  EXPECT_EQ(inspected("new.toml").at("name"), "b1") << "and not as the package of its URDF";
}

TEST_F(NewRobot, SuggestsAPackagedRobot) {
  const std::string b1 = "package://example-robot-data/robots/b1_description/urdf/b1.urdf";
  for (const char* wrong : {"b1", "b1.urdf", "package://example-robot-data/robots/b1/b1.urdf"}) {
    const Outcome none = run(std::string("$prowl new robot ") + wrong + " $dirs");
    EXPECT_EQ(none.status, 2) << wrong;
    EXPECT_THAT(none.error, HasSubstr("did you mean " + b1 + "? Packaged robots: ")) << wrong;
    EXPECT_EQ(std::ranges::count(none.error, '\n'), 1) << none.error;
  }
  EXPECT_THAT(run("$prowl new robot go22 $dirs").error, HasSubstr("go2_description/urdf/go2.urdf?"));
}

TEST_F(NewRobot, WritesNothingForWhatIsNoLeggedRobot) {
  folder_.write("folder/file", "");
  folder_.write("empty.urdf", "");
  folder_.write("text.urdf", "not a robot");
  folder_.write("cut.urdf", test::read_file(kData + kUrdfs[0].path).substr(0, 5000));
  const std::string arm = kData + "ur_description/urdf/ur10_robot.urdf",
                    no_legs = kData + "alex_description/urdf/alex_nub_hands.urdf";
  for (const std::string& urdf : {std::string("empty.urdf"), std::string("text.urdf"), std::string("cut.urdf"),
                                  std::string("missing.urdf"), std::string("folder"), arm, no_legs}) {
    const Outcome made = run("$prowl new robot '" + urdf + "' --out new.toml");
    EXPECT_EQ(made.status, 2) << urdf << made.error;
    EXPECT_THAT(made.error, HasSubstr(urdf));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "new.toml")) << urdf;
  }
}

/// A quadruped of 20 kg as MJCF: classes, motors with gears and armature, feet as spheres.
std::string mjcf_of_a_quadruped() {
  std::string legs, motors;
  for (const char* const leg : {"lf", "rf", "lh", "rh"}) {
    const double x = leg[1] == 'f' ? 0.3 : -0.3, y = leg[0] == 'l' ? 0.15 : -0.15;
    legs += fmt::format(R"(
      <body name="{0}_hip" pos="{1} {2} 0"><joint name="{0}_roll" axis="1 0 0" range="-0.8 0.8"/>
        <geom type="sphere" size="0.05" mass="1"/>
        <body name="{0}_thigh"><joint name="{0}_pitch" axis="0 1 0" range="-1.5 1.5"/>
          <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.03" mass="0.8"/>
          <body name="{0}_shin" pos="0 0 -0.3"><joint name="{0}_knee" axis="0 1 0" range="-2.4 -0.2"/>
            <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.02" mass="0.3"/>
            <geom type="sphere" pos="0 0 -0.3" size="0.025" mass="0.05"/>
          </body></body></body>)",
                        leg, x, y);
    for (const char* const joint : {"roll", "pitch", "knee"})
      motors += fmt::format("<motor joint=\"{}_{}\" gear=\"8\" ctrlrange=\"-10 10\"/>", leg, joint);
  }
  return "<mujoco model=\"quad\"><compiler angle=\"radian\" autolimits=\"true\"/><default><joint armature=\"0.02\" "
         "damping=\"0.1\"/></default><worldbody><body name=\"trunk\" pos=\"0 0 0.6\"><freejoint/>"
         "<geom type=\"box\" size=\"0.35 0.12 0.06\" mass=\"12\"/>" +
         legs + "</body></worldbody><actuator>" + motors + "</actuator></mujoco>";
}

TEST_F(NewRobot, TakesAnMjcfFile) {
  folder_.write("models/quad.xml", mjcf_of_a_quadruped());
  const Outcome made = run("$prowl new robot models/quad.xml --out mine/quad.toml");
  ASSERT_EQ(made.status, 0) << made.error;
  const json robot = inspected("mine/quad.toml");
  EXPECT_NEAR(robot.at("mass_kg").get<double>(), 20.6, 1e-9);
  EXPECT_EQ(robot.at("contacts").size(), 4U);
  for (const json& joint : robot.at("joints")) EXPECT_EQ(joint.at("damping"), 0.1);
  EXPECT_THAT(test::read_file(folder_.path() / "mine/quad.toml"),
              testing::AllOf(HasSubstr("urdf = \"quad.urdf\""), HasSubstr("lf_knee = 0.02")));
  ASSERT_EQ(run("$prowl new task mine/quad.toml --kind trot --out trot.toml").status, 0);
  EXPECT_EQ(run("$prowl plan trot.toml --out plan").status, 0);
  EXPECT_EQ(run("$prowl new robot models/quad.xml --out mine/quad.toml").status, 2) << "it exists";

  folder_.write("models/broken.xml", "<mujoco><worldbody><body/></worldbody></mujoco>");
  const Outcome refused = run("$prowl new robot models/broken.xml --out mine/broken.toml");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.error, HasSubstr("models/broken.xml: no body has a <freejoint>"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "mine/broken.urdf"));
}

class NewTask : public NewRobot {
 protected:
  /// Robot, task and plan, as a new user makes them one after the other.
  void expect_that_it_plans(const Urdf& urdf, const std::string& kind) const {
    ASSERT_EQ(make(urdf.path, "new.toml").status, 0);
    const Outcome task = run("$prowl new task new.toml $dirs --kind " + kind + " --out tasks/new.toml");
    ASSERT_EQ(task.status, 0) << task.error;
    const Outcome plan = run("$prowl plan tasks/new.toml $dirs --out out --no-gains");
    EXPECT_EQ(plan.status, 0) << urdf.name << " " << kind << plan.out << plan.error;
  }
};

TEST_F(NewTask, NamesARobotFileWhateverItIsCalled) {
  ASSERT_EQ(make(kUrdfs[5].path, "'of \"it\".toml'").status, 0);
  const Outcome made =
      run("$prowl new task 'of \"it\".toml' $dirs --kind hold --out still.toml && $prowl plan still.toml $dirs "
          "--print-phases");
  EXPECT_EQ(made.status, 0) << made.error;
}

TEST_F(NewTask, CrouchOfGo2Passes) { expect_that_it_plans(kUrdfs[2], "crouch"); }
TEST_F(NewTask, StandOfAnymalPasses) { expect_that_it_plans(kUrdfs[1], "stand"); }
TEST_F(NewTask, StepOfLaikagoPasses) { expect_that_it_plans(kUrdfs[5], "step"); }
TEST_F(NewTask, StandOfASoloThatMovesInAPlanePasses) { expect_that_it_plans(kUrdfs[12], "stand"); }
TEST_F(NewTask, StandOfARobotThatFacesAlongYPasses) { expect_that_it_plans(kUrdfs[13], "stand"); }
TEST_F(NewTask, HoldOfTalosPasses) { expect_that_it_plans(kUrdfs[4], "hold"); }

// Four commands from a URDF to a trotting robot in a browser, without an edit.
TEST_F(NewTask, TrotOfB1GoesFromUrdfToReport) {
  const std::string b1 = "package://example-robot-data/robots/b1_description/urdf/b1.urdf";
  for (const std::string& command : {"new robot " + b1, std::string("new task robots/b1.toml --kind trot"),
                                     std::string("plan tasks/b1/trot.toml"), std::string("report out/b1_trot")}) {
    const Outcome outcome = run("$prowl " + command + " $dirs");
    ASSERT_EQ(outcome.status, 0) << command << "\n" << outcome.out << outcome.error;
  }
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out/b1_trot/report.html"));
}

TEST_F(NewTask, TrotOfGo2Passes) { expect_that_it_plans(kUrdfs[2], "trot"); }
TEST_F(NewTask, WalkOfHyqPasses) { expect_that_it_plans(kUrdfs[0], "walk"); }
TEST_F(NewTask, WalkOfAnymalPasses) { expect_that_it_plans(kUrdfs[1], "walk"); }
TEST_F(NewTask, BoundOfGo2Passes) { expect_that_it_plans(kUrdfs[2], "bound"); }
TEST_F(NewTask, PronkOfAnymalPasses) { expect_that_it_plans(kUrdfs[1], "pronk"); }
TEST_F(NewTask, PaceOfB1Passes) { expect_that_it_plans(kUrdfs[8], "pace"); }

// Each gait that a task file may have is written as a task that can be read, and says how to plan it.
TEST_F(NewTask, KnowsEveryGait) {
  ASSERT_EQ(make("b1_description/urdf/b1.urdf", "b1.toml").status, 0);
  for (const std::string gait : {"walk", "trot", "pace", "bound", "pronk"}) {
    const Outcome made = run("$prowl new task b1.toml $dirs --kind " + gait + " --out " + gait + ".toml");
    EXPECT_EQ(made.status, 0) << made.error;
    EXPECT_THAT(made.out, HasSubstr("\nnext: prowl plan " + gait + ".toml\n"));
    EXPECT_THAT(test::read_file(folder_.path() / (gait + ".toml")), HasSubstr("kind = \"" + gait + "\""));
    const Outcome phases = run("$prowl plan " + gait + ".toml $dirs --print-phases");
    EXPECT_EQ(phases.status, 0) << phases.error;
    EXPECT_THAT(phases.out, HasSubstr("stride 2: "));
  }
}

// On feet in other places than a quadruped's there is no gait, and this is said.
TEST_F(NewTask, GaitsNeedFourFeet) {
  ASSERT_EQ(make(kUrdfs[4].path, "talos.toml").status, 0);
  const Outcome task = run("$prowl new task talos.toml $dirs --kind trot --out trot.toml");
  EXPECT_EQ(task.status, 2);
  EXPECT_THAT(task.error, HasSubstr("a gait needs four contacts"));
}

TEST_F(NewTask, CrouchGoesAsDeepAsTheRobotCan) {
  // Limits that leave the knees 0.3 rad: a smaller crouch, that still passes.
  ASSERT_EQ(make(kUrdfs[5].path, "new.toml").status, 0);
  const Outcome full = run("$prowl new task new.toml $dirs --out full.toml --json");
  ASSERT_EQ(full.status, 0) << full.error;
  EXPECT_EQ(json::parse(full.out).at("written"), json({"full.toml"}));
  std::string text = test::read_file(folder_.path() / "new.toml");
  for (const char* leg : {"FL", "FR", "RL", "RR"})
    text += fmt::format("[limits.{}_calf_joint]\nposition_rad = [-1.6, -0.7]\n", leg);
  folder_.write("stiff.toml", text);
  ASSERT_EQ(run("$prowl new task stiff.toml $dirs --out small.toml").status, 0);
  EXPECT_NE(test::read_file(folder_.path() / "small.toml"), test::read_file(folder_.path() / "full.toml"));
  EXPECT_EQ(run("$prowl plan small.toml $dirs --out out --no-gains").status, 0);
}

TEST_F(NewTask, IsNoneForWhatTheRobotCannotDo) {
  ASSERT_EQ(make(kUrdfs[5].path, "new.toml").status, 0);
  std::string weak = test::read_file(folder_.path() / "new.toml");
  for (const char* leg : {"FL", "FR", "RL", "RR"})
    weak += fmt::format("[limits.{}_calf_joint]\ntorque_Nm = 7.0\n", leg);
  folder_.write("weak.toml", weak);
  ASSERT_EQ(make("solo_description/robots/solo.urdf", "planar.toml").status, 0);  // hip and knee: no way to the side
  ASSERT_EQ(make("bolt_description/robots/bolt.urdf", "two_points.toml").status, 0);
  for (const auto& [arguments, reason] :
       {std::pair("weak.toml --kind hold", "calf_joint"), std::pair("planar.toml --kind step", "in a plane only"),
        std::pair("two_points.toml --kind step", "three to be balanced"),
        std::pair("two_points.toml --kind stand", "falls over")}) {
    const Outcome task = run(std::string("$prowl new task $dirs --out task.toml ") + arguments);
    EXPECT_EQ(task.status, 2) << arguments;
    EXPECT_THAT(task.error, HasSubstr(reason));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "task.toml"));
  }
}

TEST_F(NewTask, NamesTheNearestKindAndWritesNothing) {
  const Outcome result = run("$prowl new task hyq.toml $dirs --kind jumpp --out new.toml");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.error, HasSubstr("crouch"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "new.toml"));
}

}  // namespace
}  // namespace prowl
