// `prowl sweep`: its progress, and what is left of it after Ctrl-C.
#include <gmock/gmock.h>

#include <algorithm>

#include "command.hpp"

namespace prowl {
namespace {

using test::Outcome;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Sweep : public test::Command {
 protected:
  void SetUp() override { ASSERT_EQ(run("$prowl plan hold.toml $dirs --out out").status, 0); }
  nlohmann::json result() const { return nlohmann::json::parse(test::read_file(folder_.path() / "out/sweep.json")); }

  /// Ctrl-C once `text` is on stderr.
  Outcome interrupted_at(const std::string& text, const std::string& options) const {
    return run("$at_terminal sweep out $dirs " + options + " 2>progress & pid=$!; " + test::until(text) +
               "kill -INT $pid; wait $pid");
  }
};

TEST_F(Sweep, RefusesWhatIsNoSize) {
  for (const std::string option : {"--mass-spread nan", "--mass-spread 0.91", "--push-impulse nan",
                                   "--push-impulse inf", "--push-impulse-on-two-feet -1"}) {
    const Outcome refused = run("$prowl sweep out $dirs --n 1 --breakdown 0 " + option);
    EXPECT_EQ(refused.status, 2) << option;
    EXPECT_THAT(refused.error,
                HasSubstr(option.substr(option.find(' ') + 1) + " is not allowed; need a finite number "))
        << option;
  }
}

TEST_F(Sweep, DrawsOnlyWhatIsAskedFor) {
  const Outcome alone = run("$prowl sweep out $dirs --n 1 --seed 3 --only ground,push");
  EXPECT_EQ(alone.status, 0) << alone.error;
  EXPECT_THAT(alone.out, HasSubstr("(prowl simulate DIR --case SEED --only ground,push)"));
  EXPECT_THAT(result().at("worst").at(0).at("perturbation").get<std::string>(),
              AllOf(HasSubstr("mass x 1.00, friction x 1.00, ideal motors, 2.0 ms"), Not(HasSubstr("tilt 0.0")),
                    HasSubstr(" N s towards")));
  const double off = result().at("worst").at(0).at("rest_position_m");
  const auto rest_of_case = [&](const std::string& options) {
    EXPECT_NE(run("$prowl simulate out $dirs --case 3 " + options).status, 2);
    return nlohmann::json::parse(test::read_file(folder_.path() / "out/simulate.json"))
        .at("base_position_m")
        .at("rest")
        .get<double>();
  };
  EXPECT_EQ(rest_of_case("--only ground,push"), off);
  EXPECT_NE(rest_of_case(""), off);

  const Outcome misspelt = run("$prowl sweep out $dirs --n 1 --only pusch");
  EXPECT_EQ(misspelt.status, 2);
  EXPECT_THAT(misspelt.error, HasSubstr("push"));
  EXPECT_EQ(run("$prowl simulate out $dirs --only push").status, 2) << "of no case";
  const Outcome useless = run("$prowl sweep out $dirs --n 1 --only ground --push-impulse 5");
  EXPECT_EQ(useless.status, 2);
  EXPECT_THAT(useless.error, HasSubstr("--push-impulse: has no effect, as --only lacks 'push'"));
}

TEST_F(Sweep, KeepsFinishedCasesOnInterrupt) {
  const Outcome stopped = interrupted_at(" of 100 simulations", "--n 100 --seed 5");
  EXPECT_EQ(stopped.status, 130) << stopped.error;
  const nlohmann::json left = result();
  const int finished = left.at("cases");
  EXPECT_EQ(left.at("interrupted"), true);
  EXPECT_EQ(left.at("cases_asked"), 100);
  EXPECT_GE(finished, 10);
  EXPECT_LT(finished, 100);
  EXPECT_TRUE(left.at("breakdowns").empty());
  EXPECT_THAT(stopped.out, HasSubstr("interrupted: " + std::to_string(finished) + " of 100 simulations were finished"));

  // They are those of a sweep that has no more of them.
  ASSERT_EQ(run("$prowl sweep out $dirs --breakdown 0 --seed 5 --n " + std::to_string(finished)).status, 0);
  nlohmann::json whole = result();
  EXPECT_EQ(whole.at("interrupted"), false);
  EXPECT_EQ(whole.at("worst"), left.at("worst"));
  EXPECT_EQ(whole.at("worst").size(), static_cast<std::size_t>(finished));
}

TEST_F(Sweep, RunsAsManyAsAskedForAndSaysSoFirst) {
  const Outcome sweep = run("$prowl sweep out $dirs --n 4");
  EXPECT_EQ(sweep.status, 0) << sweep.error;
  EXPECT_THAT(sweep.error, testing::MatchesRegex("4 simulations of [0-9.]* s of motion\n1 of 4 simulations.*"));
  EXPECT_THAT(sweep.error, Not(HasSubstr("alone")));
  EXPECT_EQ(result().at("cases"), 4);
  EXPECT_TRUE(result().at("breakdowns").empty()) << "which are asked for with --breakdown";
}

TEST_F(Sweep, LeavesOutBreakdownsThatAreNotFoundOnInterrupt) {
  const Outcome stopped = interrupted_at("of one perturbation alone", "--n 2 --breakdown 1");
  EXPECT_EQ(stopped.status, 130) << stopped.error;
  EXPECT_EQ(result().at("interrupted"), true);
  EXPECT_EQ(result().at("cases"), 2);
  EXPECT_LT(result().at("breakdowns").size(), 6u);
  EXPECT_THAT(stopped.out, HasSubstr("interrupted during the simulations of one perturbation alone"));
}

TEST_F(Sweep, TellsEveryTenthInAPipe) {
  const Outcome sweep = run("$prowl sweep out $dirs --n 10 --breakdown 0");
  EXPECT_EQ(sweep.status, 0);
  EXPECT_EQ(std::ranges::count(sweep.error, '\n'), 11) << "what is to be done, and ten tenths: " << sweep.error;
  EXPECT_THAT(sweep.error, AllOf(HasSubstr("2 of 10 simulations: 00:"), HasSubstr(" left\n"),
                                 HasSubstr("10 of 10 simulations: 00:")));
  for (const char* control : {"\r", "\b", "\x1b"}) EXPECT_THAT(sweep.error, Not(HasSubstr(control)));
}

TEST_F(Sweep, ShowsABarInATerminal) {
  const std::string sweep = "$prowl sweep out $dirs --n 4 --breakdown 0";
  const std::string wide = run("NO_COLOR=1 script -qec \"stty cols 100; " + sweep + "\" /dev/null").out;
  EXPECT_THAT(wide, AllOf(HasSubstr("4 simulations\r\n0%   10"), HasSubstr("|----|"), HasSubstr(" left"),
                          HasSubstr("\n4 simulations: 00:")));
  EXPECT_EQ(std::ranges::count(wide, '*'), 51) << "not full";
  EXPECT_THAT(wide, Not(HasSubstr("\x1b"))) << "colours";
  const std::string narrow = run("script -qec \"stty cols 60; " + sweep + "\" /dev/null").out;
  EXPECT_THAT(narrow, AllOf(HasSubstr("2 of 4 simulations"), Not(HasSubstr("|----|")), Not(HasSubstr("\b"))));
}

}  // namespace
}  // namespace prowl
