// --json: one object on stdout and nothing else, whatever the verb and whatever came of it.
#include <gmock/gmock.h>

#include "command.hpp"
#include "verbs.hpp"

namespace prowl {
namespace {

using nlohmann::json;
using test::Outcome;
using testing::HasSubstr;

class JsonOutput : public test::Command {
 protected:
  /// Runs it with --json, looks at what all results have in common, and returns the object.
  json object(const std::string& verb, const std::string& arguments, const Outcome& outcome) const {
    const std::string context = verb + " " + arguments + "\n" + outcome.out.substr(0, 500) + outcome.error;
    const json result = json::parse(outcome.out, nullptr, false);
    EXPECT_TRUE(result.is_object()) << context;
    if (!result.is_object()) return json::object();
    EXPECT_EQ(result.value("verb", "?"), verb) << context;
    EXPECT_EQ(result.value("exit_status", -1), outcome.status) << context;
    EXPECT_NE(result.contains("error"), result.contains("written")) << context;
    return result;
  }
  json object(const std::string& verb, const std::string& arguments) const {
    return object(verb, arguments, run("$prowl " + verb + " --json " + arguments));
  }
  void expect_files(const json& result, std::size_t least) const {
    EXPECT_GE(result.at("written").size(), least);
    for (const std::string path : result.at("written"))
      EXPECT_TRUE(std::filesystem::exists(folder_.path() / path)) << path;
  }
};

TEST_F(JsonOutput, OfEveryVerbWithoutArguments) {
  const std::vector<std::string> all = test::verbs(run("$prowl --help").out);
  EXPECT_GE(all.size(), 7u);
  for (const std::string& verb : all) object(verb, "");
}

TEST_F(JsonOutput, OfResults) {
  EXPECT_EQ(object("robot", "hyq.toml $dirs").at("joints").size(), 12u);
  EXPECT_EQ(object("plan", "hold.toml $dirs --print-phases").at("phases").size(), 1u);
  expect_files(object("plan", "hold.toml $dirs --out out --dt 0.1 --report"), 5);
  expect_files(object("simulate", "out $dirs --engine rollout"), 2);
  expect_files(object("simulate", "out $dirs --report"), 3);
  EXPECT_EQ(run("$prowl simulate out $dirs --push 0.5 0 500 0 --json | grep -c exit_status.*8").out, "1\n")
      << "not a success";
  expect_files(object("sweep", "out $dirs --n 2 --breakdown 0"), 1);
  const json compared = object("compare", "hold.toml $dirs --out compared");
  expect_files(compared, 3);
  EXPECT_EQ(compared.at("robot"), "HyQ");
  EXPECT_EQ(compared.at("runs").size(), 1u);
  expect_files(object("report", "out $dirs"), 1);
  if (test::kHasPython) {
    const json figures = object("figures", "out $dirs");
    EXPECT_EQ(figures.at("figures").size(), 6u - 1u) << "HyQ without limit curves";
    EXPECT_EQ(figures.at("robot"), "HyQ");
    expect_files(figures, 15);
  }
  EXPECT_EQ(object("check", "out $dirs").at("certificate").at("passed"), true);
  EXPECT_EQ(object("plan", "hold.toml $dirs --out out --max-iterations 1").at("finished"), false);
}

TEST_F(JsonOutput, OfADiagnosis) {
  EXPECT_EQ(object("diagnose", "hold.toml $dirs").at("solvable"), true);
  // Legs that reach 18 cm higher.
  std::string high = test::kHold + "[[goal]]\ntime_s = 2.0\nbase_displacement_m = [0, 0, 0.35]\n";
  high.replace(high.find("intervals = 5"), 13, "intervals = 20");
  folder_.write("high.toml", high);
  const json result = object("diagnose", "high.toml $dirs --max-time 60");
  EXPECT_EQ(result.at("solvable"), false);
  EXPECT_EQ(result.at("exit_status"), 3);
  EXPECT_EQ(result.at("written").size(), 0u);
  EXPECT_EQ(result.at("cause").at("kind"), "goal");
  EXPECT_EQ(result.at("cause").at("subject"), "goal 1, base z");
}

TEST_F(JsonOutput, OfAPlanSaysWhichInTheSameWords) {
  ASSERT_EQ(run("$prowl plan hold.toml $dirs --out out").status, 0);
  for (const char* verb : {"check", "simulate", "report"}) {
    const json result = object(verb, "out $dirs");
    EXPECT_EQ(result.at("name"), "hold") << verb;
    EXPECT_EQ(result.at("robot"), "HyQ") << verb;
    EXPECT_EQ(result.at("directory"), std::filesystem::canonical(folder_.path() / "out").string()) << verb;
  }
}

TEST_F(JsonOutput, OfMistakesInFiles) {
  folder_.write("bad.toml", test::replaced(test::kHold, "duration_s", "  duration"));
  for (const char* verb : {"plan", "robot"}) {
    const Outcome outcome = run(std::string("$prowl ") + verb + " --json $dirs bad.toml");
    const json error = object(verb, "bad.toml", outcome).at("error");
    EXPECT_EQ(error.at("kind"), "input");
    EXPECT_EQ(error.at("file"), "bad.toml");
    EXPECT_EQ(error.at("line"), std::string(verb) == "plan" ? 4 : 2);  // the key; [[phase]], which no robot has
    EXPECT_EQ(error.at("column"), std::string(verb) == "plan" ? 3 : 1);
    EXPECT_EQ("prowl: " + error.at("message").get<std::string>() + "\n", outcome.error);
  }
}

TEST_F(JsonOutput, OfOtherErrors) {
  EXPECT_THAT(object("plan", "hold.toml --intervalls 3").at("error").at("message"),
              HasSubstr("did you mean '--intervals'?"));
  const json files = object("plan", "hold.toml $dirs --out /proc/prowl").at("error");
  EXPECT_EQ(files.at("kind"), "files");
  EXPECT_FALSE(files.contains("line"));
  EXPECT_EQ(object("simulate", "out --engine rollout --seed 3").at("exit_status"), 2);
  EXPECT_EQ(run("$prowl robot missing.toml --json >/dev/full").status, 2) << "the first error counts";
  EXPECT_EQ(run("$prowl robot missing.toml --json >&-").status, 2);
  EXPECT_EQ(object("plan", "$(printf %060000d 0)").at("error").at("kind"), "input") << "a path of any length";
  EXPECT_EQ(run("$prowl robot missing.toml").out, "") << "only if asked";
}

TEST_F(JsonOutput, OfAnInterruptedSweep) {
  ASSERT_EQ(run("$prowl plan hold.toml $dirs --out out").status, 0);
  const Outcome outcome = run("timeout --foreground -s INT 2 $prowl sweep out $dirs --n 100000 --json; exit $?");
  ASSERT_NE(outcome.out, "");
  EXPECT_EQ(json::parse(outcome.out).at("exit_status"), 130);
}

}  // namespace
}  // namespace prowl
