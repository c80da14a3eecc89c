// --help: the same form for every verb, and examples that run.
#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "command.hpp"
#include "verbs.hpp"

namespace prowl {
namespace {

using test::Outcome;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

class Help : public test::Command {
 protected:
  std::string help(const std::string& verb) const { return run("$prowl " + verb + " --help").out; }
  /// The lines below "Examples:", without what is said of them behind.
  static std::vector<std::string> examples(const std::string& help) {
    std::istringstream lines(help.substr(help.find("Examples:\n") + 10));
    std::vector<std::string> commands;
    for (std::string line; std::getline(lines, line) && line.starts_with("  prowl ");) {
      commands.push_back(line.substr(2, line.find("   ", 2) - 2));
    }
    return commands;
  }
};

TEST_F(Help, HasOneForm) {
  for (const std::string& verb : test::verbs(help(""))) {
    const std::string text = help(verb);
    EXPECT_THAT(text, HasSubstr("Usage: prowl " + verb)) << verb;
    EXPECT_GE(examples(text).size(), 1u) << verb << "\n" << text;
    EXPECT_THAT(text, HasSubstr("\nExit status: ")) << verb;
  }
}

// Flags of one name mean the same in every verb: they have the same words and take the same.
TEST_F(Help, GivesCommonFlagsTheSameWords) {
  std::map<std::string, std::set<std::string>> words;
  for (const std::string& verb : test::verbs(help(""))) {
    const std::string text = help(verb);
    for (const char* flag : {"--json", "--quiet", "--package-dir DIR", "--seed N"}) {
      const std::size_t at = text.find(std::string("  ") + flag + " ");
      if (at == std::string::npos) continue;
      const std::string line = text.substr(at, text.find('\n', at) - at);
      words[flag].insert(std::string(flag) == "--seed N" ? "" : line);
    }
  }
  EXPECT_EQ(words.size(), 4u);
  for (const auto& [flag, lines] : words) EXPECT_EQ(lines.size(), 1u) << flag << ": " << testing::PrintToString(lines);
}

// In one folder, in order, as a reader may type them. One that takes long is interrupted.
TEST_F(Help, ShowsExamplesThatRun) {
  const std::string setup = "ln -s '" PROWL_SOURCE_DIR "/tasks' '" PROWL_SOURCE_DIR
                            "/robots' .; export HOME=\"$PWD\" ROS_PACKAGE_PATH='" PROWL_ROBOTS_DATA
                            "' "
                            "PATH=\"$(dirname $prowl):$PATH\"; mkdir -p ~/.local/share/bash-completion/completions "
                            "~/.zfunc ~/.config/fish/completions; ";
  const std::string text = test::kHyqFile;
  folder_.write("new.toml", text.substr(0, text.find("contact = [")) + text.substr(text.find("[nominal")));
  std::set<std::string> ours = {"plan", "check", "robot", "simulate", "sweep", "compare", "report", "completion"};
  if (test::kHasPython) ours.insert("figures");
  int ran = 0;
  for (const std::string& verb : test::verbs(help(""))) {
    for (const std::string& example : examples(help(verb))) {
      const Outcome outcome = run(setup + "timeout -s INT 8 bash -c 'trap : INT; " + example + "'");
      EXPECT_THAT(outcome.error, Not(HasSubstr("For help: prowl"))) << example << ": is not understood";
      EXPECT_NE(outcome.status, 1) << example << "\n" << outcome.error;
      if (ours.contains(verb)) EXPECT_THAT(outcome.status, AnyOf(0, 124, 130)) << example << "\n" << outcome.error;
      ++ran;
    }
  }
  EXPECT_GE(ran, 16);
}

}  // namespace
}  // namespace prowl
