// Long solves as their user meets them: checkpoints, going on from them, signals and limits.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "command.hpp"

namespace prowl {
namespace {

using test::Command;
using test::Outcome;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

/// HyQ bows on 200 intervals, after coarser meshes: a second or more, a dozen iterations and more.
const std::string kBow = test::kHold + "[[goal]]\ntime_s = 2.0\nbase_displacement_m = [0.02, 0, -0.04]\n";

class Checkpoints : public Command {
 protected:
  Checkpoints() { folder_.write("bow.toml", kBow); }
  nlohmann::json read_plan(const std::string& name) const {
    return nlohmann::json::parse(test::read_file(folder_.path() / name / "plan.json"));
  }
  double largest_difference(const std::string& one, const std::string& other) const {
    const auto numbers = [&](const std::string& name) {
      std::string text = test::read_file(folder_.path() / name);
      std::ranges::replace(text, ',', ' ');
      std::istringstream rest(text.substr(text.find('\n')));
      return std::vector<double>(std::istream_iterator<double>(rest), {});
    };
    const std::vector<double> a = numbers(one), b = numbers(other);
    if (a.size() != b.size() || a.empty()) return INFINITY;
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
  }
  static std::vector<int> intervals(const nlohmann::json& plan) {
    std::vector<int> all;
    for (const auto& level : plan.at("solver").at("levels")) all.push_back(level.at("intervals"));
    return all;
  }
};

/// Every solver tells of its iterates, so that each can be stopped and gone on from, by itself or by another.
TEST_F(Checkpoints, KeepTheBestIterateOfEverySolver) {
  for (const std::string solver : {"riccati", "fatrop", "ipopt", "ipopt-spral", "uno"}) {
    const Outcome stopped = run("$prowl plan bow.toml $dirs --intervals 20 --solver " + solver +
                                " --out out --max-iterations 2 --one-mesh "
                                "--checkpoint so_far --checkpoint-every 0");
    EXPECT_EQ(stopped.status, 6) << solver << stopped.error;
    const nlohmann::json checkpoint = read_plan("so_far");
    EXPECT_EQ(checkpoint.at("status"), "interrupted") << solver;
    EXPECT_EQ(checkpoint.at("good"), false);
    EXPECT_LT(largest_difference("so_far/trajectory.csv", "out/trajectory.csv"), 1e-9)
        << solver << ": both are the best of the iterates";
    EXPECT_LE(checkpoint.at("solver").at("iterations").get<int>(), 2);
    const Outcome check = run("$prowl check so_far $dirs");
    EXPECT_EQ(check.status, 130) << solver << check.error;
    EXPECT_THAT(check.out, HasSubstr("(as planned): not finished: interrupted"));
    const Outcome resumed = run("$prowl plan bow.toml $dirs --intervals 20 --resume so_far --out out2 --one-mesh");
    EXPECT_THAT(resumed.status, AnyOf(0, 7)) << solver << resumed.error;  // a coarse mesh
    EXPECT_EQ(read_plan("out2").at("status"), "converged") << solver;
    EXPECT_EQ(read_plan("out2").at("solver").at("warm_start"), "so_far");
  }
}

TEST_F(Checkpoints, GoOnWithTheirMeshAndThoseAfterIt) {
  const std::string command = "$prowl plan bow.toml $dirs --intervals 200 --out out ";
  ASSERT_EQ(run(command).status, 0);
  EXPECT_EQ(intervals(plan()), (std::vector{13, 50, 200}));
  const nlohmann::json whole = plan();
  // One iteration on each mesh: the last checkpoint that is written is on the last mesh.
  EXPECT_EQ(run(command + "--max-iterations 1 --checkpoint so_far --checkpoint-every 0").status, 6);
  EXPECT_EQ(read_plan("so_far").at("problem").at("phases").at(0).at("intervals"), 200);
  // A kill in the midst of the second mesh.
  const Outcome killed = run(command +
                             "--checkpoint so_far --checkpoint-every 0 2>progress & pid=$!; "
                             "for i in $(seq 6000); do [ $(sed -n '/mesh of 50/,$p' progress | grep -c ' s$') -ge 2 ] "
                             "&& break; sleep 0.01; done; kill -9 $pid; wait $pid");
  ASSERT_EQ(killed.status, 137);
  const int mesh = read_plan("so_far").at("problem").at("phases").at(0).at("intervals");
  const Outcome resumed = run(command + "--resume so_far");
  EXPECT_EQ(resumed.status, 0) << resumed.error;
  EXPECT_EQ(intervals(plan()).front(), mesh);
  EXPECT_EQ(intervals(plan()).back(), 200);
  EXPECT_LT(intervals(plan()).size(), 3u) << "it began anew";
  EXPECT_NEAR(plan().at("solver").at("cost"), whole.at("solver").at("cost"), 1e-5)
      << "another motion than without the kill";
  // A plan that ran out of iterations serves as well, and so does a checkpoint to refine.
  EXPECT_EQ(run("$prowl plan bow.toml $dirs --intervals 40 --max-iterations 2 --out short").status, 6);
  EXPECT_EQ(run("$prowl plan bow.toml $dirs --intervals 40 --resume short --out out").status, 7) << "a coarse mesh";
  EXPECT_EQ(plan().at("status"), "converged");
  EXPECT_EQ(run("$prowl plan bow.toml $dirs --intervals 40 --resume short --out out --refine").status, 0);
}

/// What is on disk stays until there is better, and is not replaced without a word.
TEST_F(Checkpoints, AreKeptWhereTheyAreResumed) {
  const std::string plan =
      "$prowl plan bow.toml $dirs --intervals 20 --one-mesh --out out --checkpoint so_far --checkpoint-every 0 ";
  ASSERT_EQ(run(plan + "--max-iterations 2").status, 6);
  const auto violation = [&] { return read_plan("so_far").at("solver").at("constraint_violation").get<double>(); };
  const double before = violation();
  const Outcome resumed = run(plan + "--max-iterations 1 --resume so_far");
  EXPECT_EQ(resumed.status, 6) << resumed.error;
  EXPECT_THAT(resumed.error, Not(HasSubstr("replaces")));
  EXPECT_LE(violation(), before);
  const Outcome again = run(plan + "--max-iterations 1");
  EXPECT_THAT(again.error, HasSubstr("note: this replaces the checkpoint in so_far; --resume would continue from it"));
  EXPECT_GT(violation(), before);
}

/// Where it is stopped early, neither the plan nor the checkpoint goes on to finer meshes.
TEST_F(Checkpoints, StayOnTheMeshWhereTheTimeRanOut) {
  const std::string command = "$prowl plan bow.toml $dirs --intervals 200 --out out ";
  const Outcome stopped = run(command + "--max-time 1e-6 --checkpoint so_far --checkpoint-every 0");
  EXPECT_EQ(stopped.status, 6) << stopped.error;
  EXPECT_THAT(stopped.error, HasSubstr("note: stopped on a coarse mesh of 13 intervals instead of 200; "));
  EXPECT_THAT(stopped.error, HasSubstr("to continue from there, repeat the command with --resume out\n"));
  EXPECT_EQ(intervals(plan()), std::vector{13});
  EXPECT_EQ(plan().at("problem").at("phases").at(0).at("intervals"), 13);
  EXPECT_EQ(read_plan("so_far").at("problem").at("phases").at(0).at("intervals"), 13);
  EXPECT_EQ(run("$prowl check out $dirs").status, 6);
  EXPECT_EQ(run(command + "--resume out").status, 0);
  EXPECT_EQ(intervals(plan()), (std::vector{13, 50, 200}));
}

TEST_F(Checkpoints, OfSomethingElseAreRefused) {
  ASSERT_EQ(
      run("$prowl plan bow.toml $dirs --out out --max-iterations 2 --checkpoint so_far --checkpoint-every 0").status,
      6);
  const auto refusal = [&](const std::string& arguments) {
    const Outcome result = run("$prowl plan " + arguments + " $dirs --out other --resume so_far");
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_THAT(result.error, Not(HasSubstr("iteration "))) << "a solve for nothing";
    return result.error;
  };
  EXPECT_THAT(
      refusal("hold.toml"),
      HasSubstr(
          "--resume so_far: the task file is not the same as in the checkpoint; use --warm-start to start from it"));
  EXPECT_THAT(refusal("bow.toml --intervals 7"),
              HasSubstr("the checkpoint is on a mesh of 5 intervals; this solve uses meshes of 7"));
  EXPECT_THAT(refusal("bow.toml --warm-start so_far"), HasSubstr("excludes"));
  folder_.write("hyq.toml", test::kHyqFile + "# another text\n");
  EXPECT_THAT(refusal("bow.toml"), HasSubstr("the robot file is not the same as in the checkpoint"));
  folder_.write("hyq.toml", test::kHyqFile);

  const std::string json = test::read_file(folder_.path() / "so_far/plan.json"),
                    csv = test::read_file(folder_.path() / "so_far/trajectory.csv");
  folder_.write("so_far/plan.json", json.substr(0, json.size() / 2));
  EXPECT_THAT(refusal("bow.toml"), HasSubstr("so_far/plan.json:"));
  folder_.write("so_far/plan.json", json);
  folder_.write("so_far/trajectory.csv", csv.substr(0, csv.size() / 2));
  EXPECT_THAT(refusal("bow.toml"), HasSubstr("so_far/trajectory.csv:"));
  std::filesystem::remove(folder_.path() / "so_far/trajectory.csv");
  EXPECT_THAT(refusal("bow.toml"), HasSubstr("trajectory.csv: no such file"));
  ASSERT_EQ(run("$prowl plan hold.toml $dirs --out good").status, 0);
  EXPECT_THAT(run("$prowl plan hold.toml $dirs --resume good").error,
              HasSubstr("the plan is finished, nothing is left to resume"));

  EXPECT_THAT(run("$prowl plan bow.toml $dirs --out good --checkpoint ./good/").error,
              HasSubstr("need another folder"));
  EXPECT_THAT(run("$prowl plan bow.toml $dirs --out new/x --checkpoint new/x/so_far").error,
              HasSubstr("need a folder beside it"));
  EXPECT_THAT(run("$prowl plan bow.toml $dirs --out new/x/plan --checkpoint new/x/").error,
              HasSubstr("need a folder beside it"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "new"));
  EXPECT_EQ(run("$prowl plan bow.toml $dirs --out other --max-iterations 1 --checkpoint other2").status, 6)
      << "a beginning of a name is no folder";
  EXPECT_THAT(run("$prowl plan bow.toml $dirs --out other --checkpoint good").error,
              HasSubstr("--checkpoint good: holds a plan that passed"));
  EXPECT_EQ(run("$prowl plan bow.toml $dirs --checkpoint-every 3").status, 2) << "of no checkpoint";
  for (const std::string option : {"--checkpoint", "--resume", "--out", "--warm-start"}) {
    const Outcome result = run("$prowl plan bow.toml $dirs " + option + " ''");
    EXPECT_EQ(result.status, 2) << option;
    EXPECT_THAT(result.error, HasSubstr(option + ": is empty; need a folder"));
  }
  EXPECT_EQ(run("$prowl plan bow.toml $dirs --checkpoint so_far --checkpoint-every nan").status, 2);
  folder_.write("mine/thesis.tex", "years of work");
  EXPECT_EQ(run("$prowl plan bow.toml $dirs --checkpoint mine").status, 4);
}

/// So many that a dozen iterations take longer than a signal.
std::string size_for(const std::string& solver) {
  return solver == "uno" ? "20" : solver.starts_with("ipopt") ? "100" : "300";
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

TEST_F(Checkpoints, SignalsStopEverySolverWithinAnIteration) {
  for (const std::string solver : {"riccati", "fatrop", "ipopt", "ipopt-spral", "uno"}) {
    for (const std::string signal : {"INT", "TERM", "HUP"}) {
      if (signal == "HUP" && solver != "riccati") continue;  // the same to a solver
      const Outcome result = run(": >progress; $at_terminal plan bow.toml $dirs --out out --one-mesh --intervals " +
                                 size_for(solver) + " --solver " + solver + " 2>progress & pid=$!; " +
                                 test::until(test::kIteration) + "kill -" + signal + " $pid; wait $pid");
      EXPECT_EQ(result.status, 130) << solver << " " << signal << result.error;
      EXPECT_EQ(plan().at("status"), "interrupted") << solver;
      const std::string progress = test::read_file(folder_.path() / "progress");
      const std::size_t notice = progress.find("stopping after the current step");
      ASSERT_NE(notice, std::string::npos) << progress;
      EXPECT_LE(count(progress.substr(notice), " s\n"), 1) << solver << ": one was under way\n" << progress;
    }
  }
}

/// A shell and the kernel may both tell of it.
TEST_F(Checkpoints, ASecondHangUpIsIgnored) {
  const Outcome result =
      run(": >progress; $prowl plan bow.toml $dirs --out out --one-mesh --intervals 300 2>progress >said & pid=$!; " +
          test::until(test::kIteration) +
          "kill -HUP $pid; "
          "for i in $(seq 6000); do grep -q 'stopping after' progress && break; sleep 0.001; done; kill -HUP $pid; "
          "wait $pid");
  EXPECT_EQ(result.status, 130) << result.error;
  EXPECT_EQ(plan().at("status"), "interrupted");
  EXPECT_THAT(test::read_file(folder_.path() / "said"), testing::HasSubstr("interrupted")) << "it did not end at once";
}

/// A terminal that is gone reads nothing; a disk that is full has lost what was to be kept.
TEST_F(Checkpoints, AHangUpHidesNoFullDisk) {
  const Outcome result = run(
      ": >progress; $prowl plan bow.toml $dirs --out out --one-mesh --intervals 300 2>progress >/dev/full & pid=$!; " +
      test::until(test::kIteration) + "kill -HUP $pid; wait $pid");
  EXPECT_EQ(result.status, 4) << result.error;
  EXPECT_EQ(plan().at("status"), "interrupted");
}

/// A script that was stopped by Ctrl-C may have started it on purpose beside what that stops.
TEST_F(Checkpoints, CtrlCIsIgnoredWhereItWasBefore) {
  const Outcome result = run(": >progress; $prowl plan bow.toml $dirs --out out --intervals 300 2>progress & pid=$!; " +
                             test::until(test::kIteration) + "kill -INT $pid; wait $pid");
  EXPECT_EQ(result.status, 0) << result.error;
}

/// Who starts it with nohup wants it to outlive the terminal.
TEST_F(Checkpoints, NohupIsHeeded) {
  const Outcome result =
      run(": >progress; nohup $prowl plan bow.toml $dirs --out out --intervals 300 >said 2>progress & pid=$!; " +
          test::until(test::kIteration) + "kill -HUP $pid; wait $pid");
  EXPECT_EQ(result.status, 0) << result.error;
}

TEST_F(Checkpoints, LimitsOfTimeAndIterationsHold) {
  for (const std::string solver : {"riccati", "fatrop", "ipopt", "ipopt-spral", "uno"}) {
    const std::string command =
        "$prowl plan bow.toml $dirs --out out --one-mesh --intervals " + size_for(solver) + " --solver " + solver;
    EXPECT_EQ(run(command + " --max-iterations 2").status, 6) << solver;
    EXPECT_EQ(plan().at("status"), "iteration_limit") << solver;
    EXPECT_EQ(plan().at("solver").at("iterations"), 2) << solver;
    EXPECT_EQ(plan().at("solver").at("max_iterations"), 2);
    EXPECT_EQ(run(command + " --max-time 0.05").status, 6) << solver;
    EXPECT_EQ(plan().at("status"), "time_limit") << solver;
    EXPECT_GE(plan().at("solver").at("seconds"), 0.05);
    const nlohmann::json times = plan().at("solver").at("convergence").at("seconds");
    int late = 0;
    for (const auto& time : times) late += time.get<double>() > 0.05;
    EXPECT_LE(late, 1) << solver << ": more than the iteration in which the time ran out";
  }
}

}  // namespace
}  // namespace prowl
