// prowl completion in the shells themselves: what they offer for a line that has been begun.
#include <gmock/gmock.h>

#include <set>

#include "command.hpp"
#include "verbs.hpp"

namespace prowl {
namespace {

using test::Outcome;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::IsSupersetOf;
using testing::Not;

using Words = std::vector<std::string>;

Words lines_of(const std::string& text) {
  std::istringstream lines(text);
  Words words;
  for (std::string line; std::getline(lines, line);) words.push_back(line);
  return words;
}

class Completion : public test::Command {
 protected:
  void SetUp() override {
    folder_.write("notes.txt", "");
    folder_.write("out/hyq_hold/plan.json", "{}");
    folder_.write("a b/task.toml", "");
  }
  /// What bash offers after these words, the last of which may be empty; `command` prints its script.
  Words bash(const Words& words, const std::string& command = "$prowl") const {
    std::string line;
    for (const std::string& word : words) line += " '" + word + "'";
    const Outcome outcome =
        run("bash --norc -c 'set -u; source <(\"$1\" completion bash); shift; COMP_WORDS=(\"$@\"); "
            "COMP_CWORD=$(($# - 1)); _prowl; printf \"%s\\n\" \"${COMPREPLY[@]}\"' - " +
            command + line);
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_EQ(outcome.error, "") << line;
    Words offered = lines_of(outcome.out);
    if (offered == Words{""}) offered.clear();
    return offered;
  }
  bool has(const std::string& shell) const { return run("command -v " + shell).status == 0; }
  Words fish(const std::string& line, const std::string& command = "$prowl") const {
    return lines_of(run("export XDG_CONFIG_HOME=$PWD XDG_DATA_HOME=$PWD; "
                        "fish -c '$argv[1] completion fish | source; complete -C $argv[2]' " +
                        command + " '" + line + "' | cut -f1")
                        .out);
  }
  /// What an interactive zsh runs, with the program in place of prowl, for what is typed; \t is Tab.
  std::string zsh(const std::string& typed, const std::string& command = "$prowl") const {
    const Outcome outcome =
        run(command +
            " completion zsh >_prowl; echo 'fpath=($PWD $fpath); autoload -Uz compinit; compinit -u -D; PS1=; "
            "prowl() { echo \"<$*>\" }' >.zshrc; "
            "printf '" +
            typed + "\\nexit\\n' | ZDOTDIR=$PWD TERM=dumb script -qec 'zsh -i' /dev/null");
    return outcome.out + outcome.error;
  }
};

const std::string kTree = PROWL_COMPLETION_TREE;

TEST_F(Completion, OfVerbs) {
  EXPECT_THAT(bash({"prowl", "pl"}), ElementsAre("plan"));
  EXPECT_EQ(bash({"prowl", ""}), test::verbs(run("$prowl --help").out));
  EXPECT_THAT(bash({"prowl", "--v"}), ElementsAre("--version"));
}

TEST_F(Completion, OfProwlNew) {
  EXPECT_THAT(bash({"prowl", "new", "ro"}), ElementsAre("robot"));
  EXPECT_THAT(bash({"prowl", "new", "task", "--kin"}), ElementsAre("--kind"));
  EXPECT_THAT(bash({"prowl", "new", "task", "--kind", "cr"}), ElementsAre("crouch"));
}

TEST_F(Completion, OfOptionsAndTheirValues) {
  EXPECT_THAT(bash({"prowl", "plan", "--so"}), ElementsAre("--solver"));
  EXPECT_THAT(bash({"prowl", "plan", "--solver", ""}), ElementsAre("riccati", "fatrop", "ipopt", "ipopt-spral", "uno"));
  EXPECT_THAT(bash({"prowl", "plan", "--solver", "=", "f"}), ElementsAre("fatrop"))
      << "bash splits --solver=f at the =";
  EXPECT_THAT(bash({"prowl", "plan", "--solver", "="}),
              ElementsAre("riccati", "fatrop", "ipopt", "ipopt-spral", "uno"));
  EXPECT_THAT(bash({"prowl", "simulate", "out", "--engine", "r"}), ElementsAre("rollout"));
  EXPECT_THAT(bash({"prowl", "check", "--so"}), ElementsAre()) << "an option of another verb";
  EXPECT_THAT(bash({"prowl", "plan", "--dt", "h"}), ElementsAre()) << "a number is no file";
  EXPECT_THAT(bash({"prowl", "completion", ""}), ElementsAre("bash", "zsh", "fish"));
}

TEST_F(Completion, OfFilesAndFolders) {
  EXPECT_THAT(bash({"prowl", "plan", "h"}), testing::UnorderedElementsAre("hold.toml", "hyq.toml"));
  EXPECT_THAT(bash({"prowl", "plan", ""}),
              AllOf(IsSupersetOf({"hold.toml", "out", "a b"}), Not(Contains("notes.txt"))));
  EXPECT_THAT(bash({"prowl", "check", "out/"}), ElementsAre("out/hyq_hold"));
  EXPECT_THAT(bash({"prowl", "check", ""}), testing::UnorderedElementsAre("out", "a b"));
  EXPECT_THAT(bash({"prowl", "plan", "hold.toml", "--warm-start", "out/"}), ElementsAre("out/hyq_hold"));
  EXPECT_THAT(bash({"prowl", "report", "out/hyq_hold", "--out", "no"}), ElementsAre("notes.txt"));
}

// Every option that --help lists is offered, and no other.
TEST_F(Completion, OfAllOptionsOfAllVerbs) {
  int compared = 0;
  for (const std::string& verb : test::verbs(run("$prowl --help").out)) {
    std::set<std::string> listed;
    for (const std::string& line : lines_of(run("$prowl " + verb + " --help").out)) {
      if (!line.starts_with("  -")) continue;
      const std::size_t name = line.find("--");
      listed.insert(line.substr(name, line.find_first_of(" ,", name) - name));
    }
    const Words offered = bash({"prowl", verb, "--"});
    EXPECT_EQ(std::set<std::string>(offered.begin(), offered.end()), listed) << verb;
    compared += static_cast<int>(listed.size());
  }
  EXPECT_GT(compared, 50);
}

TEST_F(Completion, OfVerbsOfVerbs) {
  EXPECT_THAT(bash({"prowl", "new", ""}, kTree), ElementsAre("robot", "task"));
  EXPECT_THAT(bash({"prowl", "new", "robot", "--f"}, kTree), ElementsAre("--feet"));
  EXPECT_THAT(bash({"prowl", "new", "task", "--f"}, kTree), ElementsAre("--force"));
  EXPECT_THAT(bash({"prowl", "robot", "--f"}, kTree), ElementsAre("--frames"));
  EXPECT_THAT(bash({"prowl", "new", "robot", "--feet", ""}, kTree), ElementsAre("point", "flat"));
  EXPECT_THAT(bash({"prowl", "new", "task", "h"}, kTree), testing::UnorderedElementsAre("hold.toml", "hyq.toml"));
  EXPECT_THAT(bash({"prowl", "new", "robot", "n"}, kTree), ElementsAre("notes.txt"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "mistake")) << "a description was run";
}

TEST_F(Completion, OfATypedLine) {
  // Readline itself, in a terminal: Tab, then the line as it was completed.
  const Outcome outcome =
      run("$prowl completion bash >rc; echo 'prowl() { echo \"<$*>\"; }; PS1=' >>rc; "
          "printf 'prowl pl\\thold\\t--so\\tfat\\t\\nexit\\n' | TERM=dumb script -qec 'bash --noprofile --rcfile rc "
          "-i' /dev/null");
  EXPECT_THAT(outcome.out, testing::HasSubstr("<plan hold.toml --solver fatrop>")) << outcome.error;
}

TEST_F(Completion, OfFish) {
  if (!has("fish")) GTEST_SKIP() << "no fish here";
  EXPECT_THAT(fish("prowl pl"), ElementsAre("plan"));
  EXPECT_THAT(fish("prowl plan --so"), ElementsAre("--solver"));
  EXPECT_THAT(fish("prowl plan --solver f"), ElementsAre("fatrop"));
  EXPECT_THAT(fish("prowl plan h"), testing::UnorderedElementsAre("hold.toml", "hyq.toml"));
  EXPECT_THAT(fish("prowl check out/"), ElementsAre("out/hyq_hold/"));
  EXPECT_THAT(fish("prowl new ", kTree), ElementsAre("robot", "task"));
  EXPECT_THAT(fish("prowl new robot --f", kTree), ElementsAre("--feet"));
  EXPECT_THAT(fish("prowl new task --f", kTree), ElementsAre("--force"));
  EXPECT_THAT(fish("prowl robot --f", kTree), ElementsAre("--frames"));
  EXPECT_THAT(fish("prowl new robot --feet ", kTree), ElementsAre("flat", "point"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "mistake")) << "a description was run";
}

TEST_F(Completion, OfZsh) {
  if (!has("zsh")) GTEST_SKIP() << "no zsh here";
  EXPECT_THAT(zsh("prowl pl\\thold\\t--so\\tfat\\t"), testing::HasSubstr("<plan hold.toml --solver fatrop>"));
  EXPECT_THAT(zsh("prowl n\\tr\\t--fe\\tfl\\thyq.\\t", kTree), testing::HasSubstr("<new robot --feet flat hyq.toml>"));
  EXPECT_THAT(zsh("prowl n\\tt\\t--fo\\tho\\t", kTree), testing::HasSubstr("<new task --force hold.toml>"));
  EXPECT_THAT(zsh("prowl robot --fr\\tho\\t", kTree), testing::HasSubstr("<robot --frames hold.toml>"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "mistake")) << "a description was run";
}

TEST_F(Completion, NeedsAShellThatItKnows) {
  const Outcome outcome = run("$prowl completion csh");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
}

}  // namespace
}  // namespace prowl
