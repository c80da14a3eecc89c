#include "prowl/motion/gait.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>

#include "prowl/motion/contact_schedule.hpp"
#include "prowl/text/name_check.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using testing::ElementsAre;

Gait gait_of(const std::string& name, int strides = 2) {
  Gait gait{.pattern = gait_pattern(name), .strides = strides, .stride = {0.8, 0.8}};
  gait.duty_factor = 0.85;
  return gait;
}

/// Contacts in the air, phase by phase, as names; phases in which all stand are left out.
std::vector<std::string> swings(const std::vector<Phase>& phases, const RobotModel& robot) {
  std::vector<std::string> swings;
  for (const Phase& phase : phases) {
    std::string names;
    for (int c = 0; c < static_cast<int>(robot.contacts().size()); ++c) {
      if (std::ranges::find(phase.contacts, c, &PhaseContact::contact) != phase.contacts.end()) continue;
      names += (names.empty() ? "" : " ") + robot.contacts()[c].name;
    }
    if (!names.empty()) swings.push_back(names);
  }
  return swings;
}

std::vector<Phase> hyq_phases(const Gait& gait) {
  const RobotModel robot = test::hyq();
  return expand(gait, robot, *find_feet(robot));
}

double duration(const std::vector<Phase>& phases) {
  double sum = 0.0;
  for (const Phase& phase : phases) sum += phase.duration.max;
  return sum;
}

TEST(Gait, FindsTheFeetOfRobotsByWhereTheyAre) {
  for (const auto& [robot, names] :
       {std::pair{test::hyq(), std::array{"lf_foot", "rf_foot", "lh_foot", "rh_foot"}},
        std::pair{test::anymal_c(), std::array{"LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"}},
        std::pair{test::go2(), std::array{"FL_foot", "FR_foot", "RL_foot", "RR_foot"}},
        std::pair{test::solo12(), std::array{"FL_FOOT", "FR_FOOT", "HL_FOOT", "HR_FOOT"}}}) {
    const auto feet = find_feet(robot);
    ASSERT_TRUE(feet) << robot.name();
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(robot.contacts()[(*feet)[i]].name, names[i]) << robot.name();
    }
  }
}

TEST(Gait, FindsTheFeetOfARobotThatFacesAnotherWay) {
  RobotDescription turned = test::hyq_description();
  turned.nominal_base_rpy = {0.0, 0.0, 2.5};
  EXPECT_EQ(find_feet(RobotModel(turned)), find_feet(test::hyq()));
}

TEST(Gait, FindsNoFeetOfRobotsThatAreNotOnFourLegs) {
  EXPECT_FALSE(find_feet(test::talos())) << "eight contacts";
  RobotDescription three = test::hyq_description();
  three.contacts.pop_back();
  EXPECT_FALSE(find_feet(RobotModel(three)));
  RobotDescription two_in_one_quarter = test::hyq_description();
  two_in_one_quarter.contacts[3] = two_in_one_quarter.contacts[0];
  two_in_one_quarter.contacts[3].name = "again";
  EXPECT_FALSE(find_feet(RobotModel(two_in_one_quarter)));
}

TEST(Gait, SwingsInTheOrderOfThePattern) {
  const RobotModel robot = test::hyq();
  const auto order = [&](const char* name) { return swings(hyq_phases(gait_of(name, 1)), robot); };
  EXPECT_THAT(order("walk"), ElementsAre("lh_foot", "lf_foot", "rh_foot", "rf_foot"));
  EXPECT_THAT(order("trot"), ElementsAre("lf_foot rh_foot", "lh_foot rf_foot"));
  EXPECT_THAT(order("pace"), ElementsAre("lf_foot lh_foot", "rf_foot rh_foot"));
  EXPECT_THAT(order("bound"), ElementsAre("lh_foot rh_foot", "lf_foot rf_foot"));
}

TEST(Gait, LastsAsLongAsItsStrides) {
  ASSERT_EQ(gait_patterns().size(), 5u);
  for (const GaitPattern& pattern : gait_patterns()) {
    const Gait gait = gait_of(pattern.name, 3);
    const double stand = gait.duty_factor - pattern.least_duty_factor();
    EXPECT_GT(stand, 0.0);
    // The stand after the last swing is "settle".
    EXPECT_NEAR(duration(hyq_phases(gait)), gait.start + (3.0 - stand) * 0.8 + gait.settle, 1e-12) << pattern.name;
  }
}

TEST(Gait, EveryFootStandsForItsDutyFactor) {
  for (const GaitPattern& pattern : gait_patterns()) {
    const Gait gait = gait_of(pattern.name, 1);
    const std::vector<Phase> phases = hyq_phases(gait);
    for (int contact = 0; contact < 4; ++contact) {
      double in_the_air = 0.0;
      for (const Phase& phase : phases) {
        const bool held = std::ranges::find(phase.contacts, contact, &PhaseContact::contact) != phase.contacts.end();
        if (!held) in_the_air += phase.duration.min;
      }
      EXPECT_NEAR(in_the_air, 0.15 * 0.8, 1e-12) << pattern.name << contact;
    }
  }
}

TEST(Gait, HasNoStandsWhereTheDutyFactorLeavesNoTime) {
  Gait gait = gait_of("walk");
  gait.duty_factor = 0.75;
  EXPECT_EQ(hyq_phases(gait).size(), 1u + 2 * 4 + 1);
  gait.duty_factor = 0.76;
  EXPECT_EQ(hyq_phases(gait).size(), 1u + 2 * 8 - 1 + 1);
}

TEST(Gait, SwingsOverlapBelowTheLeastDutyFactor) {
  const RobotModel robot = test::hyq();
  const auto order = [&](const char* name, double duty_factor) {
    Gait gait = gait_of(name, 1);
    gait.duty_factor = duty_factor;
    return swings(hyq_phases(gait), robot);
  };
  const std::string all = "lf_foot lh_foot rf_foot rh_foot";
  EXPECT_THAT(order("trot", 0.4), ElementsAre("lf_foot rh_foot", all, "lh_foot rf_foot"));
  EXPECT_THAT(order("bound", 0.4), ElementsAre("lh_foot rh_foot", all, "lf_foot rf_foot"));
  EXPECT_THAT(order("pronk", 0.4), ElementsAre(all));
  EXPECT_THAT(order("walk", 0.65), ElementsAre("lh_foot", "lf_foot lh_foot", "lf_foot", "lf_foot rh_foot", "rh_foot",
                                               "rf_foot rh_foot", "rf_foot"));
}

TEST(Gait, FliesAsLongAsNoFootStands) {
  for (const auto& [name, duty_factor, flight] :
       {std::tuple{"pronk", 0.7, 0.3}, std::tuple{"bound", 0.3, 2 * 0.2}, std::tuple{"trot", 0.4, 2 * 0.1}}) {
    Gait gait = gait_of(name, 5);
    gait.duty_factor = duty_factor;
    double seconds = 0.0;
    for (const Phase& phase : hyq_phases(gait)) seconds += phase.contacts.empty() ? phase.duration.min : 0.0;
    const int flights = std::string(name) == "pronk" ? 5 : 2 * 5 - 1;  // the last swing of two ends on standing feet
    EXPECT_NEAR(seconds, flights * flight / (flights == 5 ? 1 : 2) * 0.8, 1e-12) << name;
  }
}

TEST(Gait, RobotsOfOneFroudeNumberMoveAlike) {
  for (const GaitPattern& pattern : gait_patterns()) {
    double last = 0.0;
    for (const double speed : {0.05, 0.15, 0.35}) {  // times sqrt(gravity height)
      const auto froude = [&](double height) { return speed * std::sqrt(RobotModel::kGravity * height); };
      const double small = pattern.default_stride(0.25, froude(0.25)), large = pattern.default_stride(1.0, froude(1.0));
      EXPECT_NEAR(2.0 * small, large, 1e-12);
      EXPECT_EQ(pattern.default_duty_factor(0.25, froude(0.25)), pattern.default_duty_factor(1.0, froude(1.0)));
      EXPECT_GT(small * froude(0.25), last) << "a faster gait has longer strides";
      EXPECT_LE(small * froude(0.25), pattern.longest * 0.25 + 1e-12);
      last = small * froude(0.25);
    }
  }
}

TEST(Gait, GivesEveryPhaseItsShareOfAFreeDuration) {
  Gait gait = gait_of("trot");
  gait.stride = {0.5, 1.0};
  const std::vector<Phase> phases = hyq_phases(gait);
  EXPECT_TRUE(phases.front().duration.is_fixed());
  EXPECT_TRUE(phases.back().duration.is_fixed());
  double least = 0.0;
  for (std::size_t p = 1; p + 1 < phases.size(); ++p) {
    EXPECT_NEAR(phases[p].duration.max, 2.0 * phases[p].duration.min, 1e-12);
    least += phases[p].duration.min;
  }
  EXPECT_NEAR(least, 2 * 0.5 - 0.35 * 0.5, 1e-12);
}

TEST(Gait, NamesArePhaseNamesAndUnique) {
  for (const GaitPattern& pattern : gait_patterns()) {
    std::set<std::string> names;
    const std::vector<Phase> phases = hyq_phases(gait_of(pattern.name));
    for (const Phase& phase : phases) {
      EXPECT_TRUE(is_name(phase.name)) << phase.name;
      names.insert(phase.name);
    }
    EXPECT_EQ(names.size(), phases.size());
  }
  EXPECT_EQ(hyq_phases(gait_of("trot"))[2].name, "stride 1: lf_foot and rh_foot land");
  EXPECT_EQ(hyq_phases(gait_of("walk"))[1].name, "stride 1: lh_foot swings");
}

TEST(Gait, FeetHoldItsSurfaceAndChooseTheirFoothold) {
  Gait gait = gait_of("pace");
  gait.surface = 1;
  MotionProblem problem{.robot = test::hyq()};
  problem.phases = hyq_phases(gait);
  for (const Phase& phase : problem.phases) {
    for (const PhaseContact& held : phase.contacts) {
      EXPECT_EQ(held.surface, 1);
      EXPECT_FALSE(held.foothold);
    }
  }
  const ContactSchedule schedule(problem);
  EXPECT_EQ(std::ranges::count_if(schedule.stances(), &ContactStance::lands), 8) << "two strides of four feet";
}

TEST(Gait, AnArcIsAsLongAsManyShortChords) {
  Surface slope;
  slope.normal = Eigen::Vector3d(0.0, 0.0, 1.0);
  for (const double turn : {0.0, 0.4, -1.5, 3.0}) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    constexpr int kPieces = 20000;
    for (int i = 0; i < kPieces; ++i) sum += along_surface(slope, 0.3 + turn * (i + 0.5) / kPieces, 2.0 / kPieces);
    EXPECT_LT((along_arc(slope, 0.3, 2.0, turn) - sum).norm(), 1e-6) << turn;
  }
}

TEST(Gait, GoesAlongItsSurface) {
  EXPECT_TRUE(along_surface(Surface{}, 0.0, 2.0).isApprox(Eigen::Vector3d(2.0, 0.0, 0.0)));
  EXPECT_TRUE(along_surface(Surface{}, M_PI / 2, 1.0).isApprox(Eigen::Vector3d(0.0, 1.0, 0.0)));
  Surface slope;
  slope.normal = Eigen::Vector3d(-std::sin(0.26), 0.0, std::cos(0.26));
  for (const double heading : {0.0, 0.7, -2.0}) {
    const Eigen::Vector3d d = along_surface(slope, heading, 1.5);
    EXPECT_NEAR(d.norm(), 1.5, 1e-12);
    EXPECT_NEAR(d.dot(slope.normal), 0.0, 1e-12);
    EXPECT_NEAR(std::atan2(d.y(), d.x()), heading, 1e-12) << "seen from above";
  }
  EXPECT_NEAR(along_surface(slope, 0.0, 1.0).z(), std::sin(0.26), 1e-12) << "uphill";
}

}  // namespace
}  // namespace prowl
