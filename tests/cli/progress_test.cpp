// What verbs that take long say meanwhile: a bar in a terminal, lines elsewhere, nothing if told to be quiet.
#include <gmock/gmock.h>

#include "command.hpp"

namespace prowl {
namespace {

using test::Outcome;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Progress : public test::Command {
 protected:
  /// stdout and stderr as one, of a terminal of that many columns.
  std::string in_terminal(const std::string& command, int columns = 100, const std::string& environment = "") const {
    return run(environment + " script -qec \"stty cols " + std::to_string(columns) + "; " + command + "\" /dev/null")
        .out;
  }
  void expect_bar(const std::string& command, const std::string& what) const {
    const Outcome piped = run(command);
    EXPECT_THAT(piped.error, AllOf(HasSubstr(" " + what + ": 00:"), HasSubstr(" left\n"))) << command;
    for (const char* control : {"\r", "\b", "\x1b"})
      EXPECT_THAT(piped.error + piped.out, Not(HasSubstr(control))) << command;
    const std::string terminal = in_terminal(command, 100, "NO_COLOR=1");
    EXPECT_THAT(terminal, AllOf(HasSubstr(" " + what + "\r\n0%   10"), HasSubstr("|----|"), HasSubstr(" left")))
        << command;
    EXPECT_THAT(terminal, HasSubstr(" " + what + ": 00:")) << command << ": does not end";
    EXPECT_THAT(terminal, Not(HasSubstr("\x1b"))) << command;
  }
  /// A second of solving, some more for each of what follows.
  void plan_hold() const { ASSERT_EQ(run("$prowl plan hold.toml $dirs --out out").status, 0); }
};

TEST_F(Progress, OfGains) {
  const std::string slow = test::replaced(test::kHold, "duration_s = 2.0",
                                          "duration_s = 5.0");  // 50,000 gains: seconds on a fast machine, too
  folder_.write("fine.toml", slow + "[tracking]\nstep_s = 1e-4\n");
  expect_bar("$prowl plan fine.toml $dirs --out out", "gains");
}

TEST_F(Progress, OfASimulation) {
  plan_hold();
  expect_bar("$prowl simulate out $dirs --step 1e-5", "ms of motion");
}

TEST_F(Progress, OfARollout) {
  plan_hold();
  expect_bar("$prowl simulate out $dirs --engine rollout --control-rate 10000", "ms of motion");
}

TEST_F(Progress, OfFigures) {
  plan_hold();
  expect_bar("$prowl figures out $dirs", "figures");
}

TEST_F(Progress, OnlyOfWhatTakesLong) {
  plan_hold();
  const std::string simulate = "$prowl simulate out $dirs --perfect-state --step 0.002";
  EXPECT_EQ(run(simulate).error, "");
  EXPECT_THAT(in_terminal(simulate), Not(HasSubstr("|----|")));
}

TEST_F(Progress, IsLeftOutIfAsked) {
  EXPECT_EQ(run("$prowl plan hold.toml $dirs --out out --quiet").error, "");
  EXPECT_EQ(run("$prowl sweep out $dirs --n 10 --breakdown 0 --quiet").error, "");
  EXPECT_THAT(in_terminal("$prowl sweep out $dirs --n 10 --breakdown 0 --quiet"), Not(HasSubstr("|----|")));
  EXPECT_THAT(run("$prowl figures out $dirs --quiet").error,
              AllOf(HasSubstr("no simulation in out"), Not(HasSubstr("figures:"))));
  EXPECT_THAT(run("$prowl plan nothing.toml --quiet").error, HasSubstr("no such file")) << "an error is no progress";
}

TEST_F(Progress, GoesBackOnlyWhereTheTerminalCan) {
  plan_hold();
  const std::string sweep = "$prowl sweep out $dirs --n 4 --breakdown 0";
  EXPECT_THAT(in_terminal(sweep, 100, "TERM=dumb"), AllOf(HasSubstr("2 of 4 simulations"), Not(HasSubstr("\b"))));
  EXPECT_THAT(in_terminal(sweep, 100, "NO_COLOR=1 TERM=xterm-256color"),
              AllOf(HasSubstr("|----|"), Not(HasSubstr("\x1b"))));
}

}  // namespace
}  // namespace prowl
