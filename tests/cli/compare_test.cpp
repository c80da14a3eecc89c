// `prowl compare`: a grid of runs in one table.
#include <gmock/gmock.h>

#include <algorithm>

#include "command.hpp"

namespace prowl {
namespace {

using test::Outcome;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Compare : public test::Command {
 protected:
  /// The base moves by 5 cm, which its legs are to do with little change of posture.
  Compare() {
    folder_.write(
        "shift.toml",
        test::kHold +
            "[[goal]]\ntime_s = 2.0\nbase_displacement_m = [0.05, 0.0, -0.05]\nbase_linear_velocity_mps = [0, 0, 0]\n");
  }
  nlohmann::json table(const std::string& folder = "out") const {
    return nlohmann::json::parse(test::read_file(folder_.path() / folder / "compare.json"));
  }
  std::vector<std::string> files(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / folder)) {
      names.push_back(entry.path().filename());
    }
    std::ranges::sort(names);
    return names;
  }
};

TEST_F(Compare, FindsTheSameOptimumWithTwoSolvers) {
  const Outcome outcome = run("$prowl compare shift.toml $dirs --solver riccati,ipopt --tolerance 1e-9 --out out");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(files("out"), ElementsAre("compare.csv", "compare.json", "compare.md"));
  const nlohmann::json runs = table().at("runs");
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].at("solver"), "riccati");
  EXPECT_EQ(runs[1].at("solver"), "ipopt");
  const double cost = runs[0].at("cost");
  EXPECT_GT(cost, 0.0);
  EXPECT_NEAR(runs[1].at("cost").get<double>(), cost, 1e-6 * cost);
  for (const auto& line : runs) {
    EXPECT_EQ(line.at("status"), "converged");
    EXPECT_EQ(line.at("variables"), 6 * 66);
    EXPECT_EQ(line.at("nodes"), 6);
    EXPECT_GT(line.at("seconds"), 0.0);
  }
  EXPECT_EQ(outcome.out, test::read_file(folder_.path() / "out/compare.md") + "\nwritten to out\n");
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("\n| riccati |"), HasSubstr("\n| ipopt ")));
  EXPECT_THAT(outcome.error, HasSubstr("2 of 2 runs: 00:"));
}

TEST_F(Compare, RunsEveryCombinationOfWhatIsAskedFor) {
  const Outcome outcome =
      run("$prowl compare hold.toml $dirs --solver all --intervals 4,6 --intervals 5 --formulation inverse "
          "--transcription trapezoid --contact stabilised --orientation se3 --json --quiet");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(outcome.error, "");
  const nlohmann::json result = nlohmann::json::parse(outcome.out);
  std::vector<std::string> lines;
  for (const auto& line : result.at("runs")) {
    lines.push_back(line.at("solver").get<std::string>() + " " + std::to_string(line.at("intervals").get<int>()));
    EXPECT_EQ(line.at("nodes").get<int>(), line.at("intervals").get<int>() + 1);
  }
  for (const char* solver : {"riccati ", "fatrop ", "ipopt "}) {
    for (const char* intervals : {"4", "6", "5"})
      EXPECT_THAT(lines, testing::Contains(std::string(solver) + intervals));
  }
  EXPECT_EQ(lines.size() % 3, 0u);
  EXPECT_EQ(result.at("runs_asked"), lines.size());
  for (const std::string path : result.at("written"))
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / path)) << path;
  EXPECT_EQ(result.at("written").size(), 3u);
}

// Whatever there is to choose from: what does not go together says why.
TEST_F(Compare, HasALineForAllChoices) {
  const Outcome outcome =
      run("$prowl compare hold.toml $dirs --intervals 1 --formulation all --transcription all --contact all "
          "--orientation all "
          "--solver all --max-iterations 1 --out out");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const nlohmann::json compared = table();
  EXPECT_EQ(compared.at("runs").size(), compared.at("runs_asked"));
  for (const auto& line : compared.at("runs")) {
    const bool was_run = line.at("status") != "not run";
    EXPECT_EQ(was_run, line.at("cost").is_number()) << line;
    if (!was_run) EXPECT_TRUE(line.at("note").is_string() && line.at("note") != "") << line;
  }
}

TEST_F(Compare, PassesItsLimitsOn) {
  ASSERT_EQ(run("$prowl compare shift.toml $dirs --max-iterations 1 --hessian gauss-newton --out out").status, 0);
  const nlohmann::json line = table().at("runs")[0];
  EXPECT_EQ(line.at("status"), "iteration_limit");
  EXPECT_EQ(line.at("iterations"), 1);
  EXPECT_EQ(line.at("hessian"), "gauss-newton");
  EXPECT_EQ(line.at("grade"), "failed");
  EXPECT_NE(line.at("note"), nullptr);
  EXPECT_EQ(table().at("max_iterations"), 1);
  ASSERT_EQ(run("$prowl compare shift.toml $dirs --max-iterations 1 --out exact").status, 0);
  EXPECT_NE(table("exact").at("runs")[0].at("cost"), line.at("cost")) << "another Hessian, another step";
}

TEST_F(Compare, StartsFromTheGuessThatIsAskedFor) {
  ASSERT_EQ(run("$prowl compare shift.toml $dirs --solver ipopt --guess straight --out out").status, 0);
  ASSERT_EQ(run("$prowl compare shift.toml $dirs --solver ipopt --guess smooth --out smooth").status, 0);
  EXPECT_EQ(table().at("guess"), "straight");
  EXPECT_NE(table("smooth").at("runs")[0].at("cost"), table().at("runs")[0].at("cost"))
      << "another start, other last digits";
}

/// The double solves nothing: it says of the start whether it is feasible, which this one is.
TEST_F(Compare, RunsTheUsersOwnSnopt) {
  const Outcome outcome =
      run("$prowl compare hold.toml $dirs --solver snopt --snopt-library '" PROWL_SNOPT_DOUBLE "' --out out");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const nlohmann::json line = table().at("runs")[0];
  EXPECT_EQ(line.at("solver"), "snopt");
  EXPECT_EQ(line.at("solver_version"), "SNOPT 7");
  EXPECT_EQ(line.at("status"), "converged") << line;
  EXPECT_EQ(line.at("iterations"), 7) << "what the double says";
}

TEST_F(Compare, SaysWhatSnoptLacks) {
  const Outcome none = run("$prowl compare hold.toml $dirs --solver snopt");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.error, AllOf(HasSubstr("SNOPT is commercial"), HasSubstr("libsnopt7.so"),
                                HasSubstr("--snopt-library FILE"), HasSubstr("prowl.snopt in Python")));
  const Outcome no_library = run("$prowl compare hold.toml $dirs --solver snopt --snopt-library ./libsnopt7.so");
  EXPECT_EQ(no_library.status, 2);
  EXPECT_THAT(no_library.error, AllOf(HasSubstr("--snopt-library: SNOPT is commercial"), HasSubstr("./libsnopt7.so")));
}

TEST_F(Compare, RefusesWhatThereIsNot) {
  const Outcome solver = run("$prowl compare hold.toml $dirs --solver riccati,magic");
  EXPECT_EQ(solver.status, 2);
  EXPECT_THAT(solver.error, AllOf(HasSubstr("--solver"), HasSubstr("magic"), HasSubstr("ipopt")));
  EXPECT_EQ(run("$prowl compare hold.toml $dirs --intervals 0").status, 2);
  EXPECT_EQ(run("$prowl compare hold.toml $dirs --transcription magic").status, 2);
  EXPECT_EQ(run("$prowl compare missing.toml $dirs").status, 2);
  EXPECT_EQ(run("$prowl compare hold.toml $dirs --out /proc/prowl").status, 4);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_FALSE(entry.is_directory()) << entry.path() << ": something was written";
  }
}

TEST_F(Compare, LeavesOtherFilesAlone) {
  folder_.write("out/notes.txt", "mine");
  const Outcome outcome = run("$prowl compare hold.toml $dirs --out out");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.error, AllOf(HasSubstr("notes.txt"), Not(HasSubstr("runs"))));
  EXPECT_THAT(files("out"), ElementsAre("notes.txt"));
  ASSERT_EQ(run("rm -r out; $prowl compare hold.toml $dirs --out out").status, 0);
  ASSERT_EQ(run("$prowl compare hold.toml $dirs --out out --solver ipopt").status, 0);
  EXPECT_EQ(table().at("runs")[0].at("solver"), "ipopt") << "its own are replaced";
}

TEST_F(Compare, KeepsFinishedRunsOnInterrupt) {
  std::string meshes = "5";
  for (int i = 1; i < 50; ++i) meshes += ",30";
  const Outcome stopped = run("$at_terminal compare shift.toml $dirs --out out --solver ipopt --intervals " + meshes +
                              " 2>progress & pid=$!; " + test::until(" of 50 runs") + "kill -INT $pid; wait $pid");
  EXPECT_EQ(stopped.status, 130) << stopped.error;
  const nlohmann::json left = table();
  EXPECT_EQ(left.at("interrupted"), true);
  EXPECT_EQ(left.at("runs_asked"), 50);
  EXPECT_GE(left.at("runs").size(), 1u);
  EXPECT_LT(left.at("runs").size(), 50u);
  for (const auto& line : left.at("runs")) EXPECT_EQ(line.at("status"), "converged") << "half a run is none";
  EXPECT_THAT(stopped.out,
              HasSubstr("Interrupted: " + std::to_string(left.at("runs").size()) + " of 50 runs were finished."));
}

TEST_F(Compare, WritesNothingIfNothingWasFinished) {
  const Outcome stopped =
      run("$at_terminal compare shift.toml $dirs --out out --solver ipopt --intervals 300 --tolerance 1e-12 "
          "--json 2>err & pid=$!; sleep 1; kill -INT $pid; wait $pid");
  EXPECT_EQ(stopped.status, 130);
  EXPECT_EQ(nlohmann::json::parse(stopped.out).at("error").at("kind"), "interrupted");
  EXPECT_FALSE(written());
}

}  // namespace
}  // namespace prowl
