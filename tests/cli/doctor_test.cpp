// prowl doctor: what it says is so, and what it misses it says.
#include <gmock/gmock.h>

#include <algorithm>

#include "command.hpp"

namespace prowl {
namespace {

using nlohmann::json;
using test::Command;
using test::Outcome;
using testing::HasSubstr;

json named(const json& checks, const std::string& name) {
  const auto found =
      std::find_if(checks.begin(), checks.end(), [&](const json& check) { return check.at("name") == name; });
  return found == checks.end() ? json() : *found;
}

TEST_F(Command, DoctorFindsThatTheSolversWork) {
  const Outcome result = run("ROS_PACKAGE_PATH=" PROWL_ROBOTS_DATA " $prowl doctor --json");
  EXPECT_EQ(result.status, 0) << result.out << result.error;
  const json report = json::parse(result.out);
  EXPECT_EQ(report.at("ok"), true);
  const json& checks = report.at("checks");
  for (const char* solver : {"Riccati", "Fatrop", "Ipopt", "Ipopt-SPRAL", "Uno"}) {
    const auto found = std::find_if(checks.begin(), checks.end(), [&](const json& check) {
      return check.at("area") == "solvers" && check.at("name") == solver;
    });
    ASSERT_NE(found, checks.end()) << solver;
    EXPECT_THAT(found->at("text").get<std::string>(), HasSubstr("solves and passes")) << solver;
  }
  for (const char* name :
       {"prowl", "Pinocchio", "MuJoCo", "processor", "cores", "memory", "robots", "figures", "export", "report"}) {
    ASSERT_FALSE(named(checks, name).is_null()) << name;
    EXPECT_FALSE(named(checks, name).at("text").get<std::string>().empty()) << name;
  }
  EXPECT_THAT(named(checks, "Fatrop").at("text").get<std::string>(), HasSubstr("BLASFEO"));
  for (const json& check : checks) {
    EXPECT_TRUE(check.at("state") == "ok" || !check.at("remedy").get<std::string>().empty()) << check;
  }
}

/// As where LD_LIBRARY_PATH has another Ipopt first.
TEST_F(Command, AnotherIpoptIsNamedBeforeItIsUsed) {
  const std::string old = "LD_PRELOAD='" PROWL_OLD_IPOPT "' $prowl ";
  const Outcome plan = run(old + "plan hold.toml $dirs --solver ipopt --out out");
  EXPECT_EQ(plan.status, 2);
  EXPECT_THAT(plan.error, HasSubstr("is Ipopt 3.11.9, and this Prowl was built with Ipopt 3.14"));
  EXPECT_THAT(plan.error, HasSubstr("LD_LIBRARY_PATH"));
  EXPECT_THAT(plan.error, HasSubstr("old_ipopt")) << "where it is";
  EXPECT_FALSE(written());
  EXPECT_THAT(run(old + "--version").out, HasSubstr("Ipopt 3.11.9"));
  const Outcome doctor = run("ROS_PACKAGE_PATH=" PROWL_ROBOTS_DATA " " + old + "doctor");
  EXPECT_EQ(doctor.status, 3) << doctor.out << doctor.error;
  EXPECT_THAT(doctor.out, HasSubstr("does not solve a small task: "));
  EXPECT_THAT(doctor.out, HasSubstr("is Ipopt 3.11.9, and this Prowl was built with"));
}

TEST_F(Command, DoctorNamesLibrariesThatTheLinkerMayTakeInstead) {
  const Outcome result = run("mkdir other; touch other/libpinocchio_default.so.9; LD_LIBRARY_PATH=other $prowl doctor");
  EXPECT_THAT(result.out, HasSubstr("other/libpinocchio_default.so.9 may be loaded instead of Prowl's own"));
  EXPECT_THAT(result.out, HasSubstr("foreign: libraries"));
}

/// The program alone in a folder, without the files beside it and away from the .venv.
TEST_F(Command, DoctorSaysWhatIsMissingAndHowToGetIt) {
  const Outcome result =
      run("mkdir bin; cp $prowl bin/prowl; unset ROS_PACKAGE_PATH AMENT_PREFIX_PATH; bin/prowl doctor");
  EXPECT_EQ(result.status, 4) << result.out << result.error;
  EXPECT_THAT(result.out, HasSubstr("missing: robots, figures, export, report"));
  EXPECT_THAT(result.out, HasSubstr("scripts/setup"));
  EXPECT_THAT(result.out, HasSubstr("solves and passes"));
}

}  // namespace
}  // namespace prowl
