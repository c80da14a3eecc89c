// The command as a user meets it: the real binary, its exit status, what it prints and what it writes.
#include "command.hpp"

#include <gmock/gmock.h>

#include "prowl/tracker/tracker.hpp"

namespace prowl {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using test::Command;
using test::kHold;
using test::kPhase;
using test::Outcome;

/// Down and forward, in legs that bend faster and faster.
const std::string kBow =
    "[[goal]]\ntime_s = 2.0\nbase_displacement_m = [0.03, 0, -0.1]\nbase_linear_velocity_mps = [0, 0, 0]\n"
    "[cost]\njoint_velocity = 0.1\njoint_acceleration = 0.01\ntorque = 1e-4\n";

/// Without the line breaks that fit text to a screen.
std::string unwrapped(const std::string& text) {
  std::istringstream input(text);
  std::string words;
  for (std::string word; input >> word;) words += (words.empty() ? "" : " ") + word;
  return words;
}

TEST_F(Command, TellsVersionsAndHelp) {
  const Outcome version = run("$prowl --version");
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.out, StartsWith("prowl "));
  for (const char* part : {"Ipopt 3.14", "Pinocchio 4", "Eigen 3.4"}) EXPECT_THAT(version.out, HasSubstr(part));
  for (const char* verb : {"", "plan", "check", "robot", "simulate", "sweep", "report", "export"}) {
    const Outcome help = run(std::string("$prowl ") + verb + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("Example")) << verb;
  }
}

TEST_F(Command, SuggestsWhatWasMeant) {
  const Outcome verb = run("$prowl plna hold.toml");
  EXPECT_EQ(verb.status, 2);
  EXPECT_THAT(verb.error, HasSubstr("did you mean 'plan'?"));
  const Outcome option = run("$prowl plan hold.toml --intervalls 7");
  EXPECT_EQ(option.status, 2);
  EXPECT_THAT(option.error, HasSubstr("did you mean '--intervals'?"));
  EXPECT_EQ(run("$prowl plan").status, 2);
  const Outcome task = run("$prowl plan hyq/crouhc");
  EXPECT_EQ(task.status, 2);
  EXPECT_THAT(task.error, HasSubstr("no shipped task of that name; did you mean 'hyq/crouch'?"));
  EXPECT_THAT(run("$prowl plan crouhc.toml").error, Not(HasSubstr("did you mean"))) << "a file of the user's own";
  const Outcome format = run("$prowl export out --format csv,mujco");
  EXPECT_EQ(format.status, 2);
  EXPECT_THAT(format.error, HasSubstr("did you mean 'mujoco'?"));
}

TEST_F(Command, PrintsItsHelpAlone) {
  const Outcome alone = run("$prowl");
  EXPECT_EQ(alone.status, 2) << "nothing was done";
  EXPECT_EQ(alone.out, run("$prowl --help").out);
  EXPECT_EQ(alone.error, "");
}

// What CLI11 says of it has the value of the option, too, and in the other order.
TEST_F(Command, NamesTheMisspeltOptionOnly) {
  const std::string more = "\nFor help: prowl plan --help\n";
  EXPECT_EQ(run("$prowl plan hold.toml --interval 3").error,
            "prowl: unknown option --interval; did you mean '--intervals'?" + more);
  EXPECT_EQ(run("$prowl plan hold.toml --interval=3 --out out").error,
            "prowl: unknown option --interval; did you mean '--intervals'?" + more);
  EXPECT_EQ(run("$prowl plan hold.toml other.toml").error, "prowl: unexpected argument 'other.toml'" + more);
  EXPECT_THAT(run("$prowl plna hold.toml").error, StartsWith("prowl: unknown command 'plna'; did you mean 'plan'?\n"));
  EXPECT_THAT(run("$prowl new").error, StartsWith("prowl: a command is missing; need one of: robot, task"));
}

TEST_F(Command, TellsAllMistakesOfAFileInOneRun) {
  folder_.write("wrong.toml",
                "robot = \"hyq.toml\"\n[[phase]]\ncontacts = \"all\"\nduration = 2.0\nintervals = 0\n"
                "[solver]\ntolerence = 1e-6\n");
  const Outcome wrong = run("$prowl plan wrong.toml $dirs");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.error, AllOf(StartsWith("prowl: wrong.toml:4:1: "), HasSubstr("\nwrong.toml:5:13: "),
                                 HasSubstr("\nwrong.toml:7:1: ")));
  const auto error = nlohmann::json::parse(run("$prowl plan wrong.toml $dirs --json").out).at("error");
  EXPECT_EQ(error.at("line"), 4);
  EXPECT_THAT(error.at("message").get<std::string>(), HasSubstr("tolerence"));
}

TEST_F(Command, ShowsARobot) {
  const Outcome text = run("$prowl robot hyq.toml $dirs");
  EXPECT_EQ(text.status, 0) << text.error;
  EXPECT_THAT(text.out, HasSubstr("rank 12"));
  EXPECT_THAT(text.out, HasSubstr("150 N m"));
  const auto json = nlohmann::json::parse(run("$prowl robot hyq.toml $dirs --json").out);
  EXPECT_EQ(json.at("joints").size(), 12u);
  EXPECT_EQ(run("$prowl robot hyq.toml $dirs >/dev/full").status, 4) << "standard output on a full disk";
}

TEST_F(Command, PlansAndChecks) {
  const Outcome result = run("$prowl plan hold.toml $dirs --out out --dt 0.1");
  ASSERT_EQ(result.status, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("certificate: passed"));
  EXPECT_THAT(result.error, HasSubstr("iteration      objective")) << "no progress";
  EXPECT_THAT(result.error + result.out, Not(HasSubstr("\x1b"))) << "terminal codes in a pipe";
  EXPECT_EQ(plan().at("status"), "converged");
  EXPECT_EQ(plan().at("finished"), true);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out/trajectory_uniform.csv"));
  EXPECT_EQ(run("$prowl check out $dirs").status, 0);

  // Another torque at one node: the motion no longer follows from it.
  const auto csv = folder_.path() / "out/trajectory.csv";
  std::istringstream lines(test::read_file(csv));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("0.8,")) {
      std::size_t at = 0;
      for (int column = 0; column < 21 + 36 + 2; ++column) at = line.find(',', at) + 1;
      line = line.substr(0, at) + "149" + line.substr(line.find(',', at));
    }
    text += line + "\n";
  }
  folder_.write("out/trajectory.csv", text);
  const Outcome check = run("$prowl check out $dirs");
  EXPECT_EQ(check.status, 7) << check.out << check.error;
  EXPECT_THAT(check.out, HasSubstr("FAIL"));
}

TEST_F(Command, WritesGainsUnlessAskedNotTo) {
  const Outcome result = run("$prowl plan hold.toml $dirs --out out");
  ASSERT_EQ(result.status, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("feedback: 1003 gains, one every 2 ms"));
  const nlohmann::json tracking = plan().at("tracking");
  EXPECT_EQ(tracking.at("stands_on"), true);
  EXPECT_EQ(tracking.at("phases").size(), 1u);
  EXPECT_LT(tracking.at("whole").at("worst"), 1e-3);

  const Tracker tracker = Tracker::read((folder_.path() / "out/tracker.bin").string());
  EXPECT_EQ(tracker.plan().joint_names.front(), "lf_haa_joint");
  EXPECT_EQ(tracker.plan().contact_names.size(), 4u);
  EXPECT_EQ(tracker.plan().num_samples(), tracking.at("samples"));
  EXPECT_NEAR(tracker.end(), 2.002, 1e-9) << "and one step of standing on";

  EXPECT_EQ(run("$prowl plan hold.toml $dirs --out out --no-gains").status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out/tracker.bin")) << "gains of another plan";
  EXPECT_TRUE(plan().at("tracking").is_null());
}

TEST_F(Command, SimulatesAndSweeps) {
  ASSERT_EQ(run("$prowl plan hold.toml $dirs --out out").status, 0);
  const Outcome first = run("$prowl simulate out $dirs --json");
  EXPECT_EQ(first.status, 0) << first.error << first.out;
  EXPECT_EQ(nlohmann::json::parse(first.out).at("success"), true);
  EXPECT_EQ(run("$prowl simulate out $dirs --json").out, first.out) << "the same seed";
  EXPECT_NE(run("$prowl simulate out $dirs --json --seed 2").out, first.out);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out/simulate.csv"));
  const Outcome pushed = run("$prowl simulate out $dirs --push 0.5 0 500 0");
  EXPECT_EQ(pushed.status, 8) << pushed.out;
  EXPECT_THAT(pushed.out, HasSubstr("fell at"));
  EXPECT_EQ(run("$prowl simulate out $dirs --delay -1").status, 2);
  const Outcome sweep = run("$prowl sweep out $dirs --n 2 --breakdown 0 --json");
  EXPECT_EQ(sweep.status, 0) << sweep.error;
  EXPECT_EQ(nlohmann::json::parse(sweep.out).at("cases"), 2);
  EXPECT_EQ(run("$prowl plan hold.toml $dirs --out out").status, 0) << "its own files are in the way";
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out/simulate.json")) << "of the plan before";
  const Outcome without = run("rm out/tracker.bin; $prowl simulate out $dirs");
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.error, HasSubstr("--no-gains"));
}

TEST_F(Command, WritesAReportAndRemovesItWithThePlan) {
  EXPECT_EQ(run("$prowl plan hold.toml $dirs --out out --report").status, 0);
  const std::string with_plan = test::read_file(folder_.path() / "out/report.html");
  EXPECT_THAT(with_plan, StartsWith("<!doctype html>"));

  const Outcome again = run("$prowl report out $dirs --out other.html");
  EXPECT_EQ(again.status, 0) << again.error;
  EXPECT_THAT(again.error, HasSubstr("report: other.html, "));
  EXPECT_THAT(again.error, HasSubstr("there is no simulation"));
  const std::string alone = test::read_file(folder_.path() / "other.html");
  const auto motion = [](const std::string& html) { return html.substr(html.find("\"placements\""), 10000); };
  EXPECT_EQ(motion(alone), motion(with_plan));

  EXPECT_EQ(run("$prowl plan hold.toml $dirs --out out").status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out/report.html")) << "of a plan that is no more";
}

TEST_F(Command, ComparesTwoPlansInOneReport) {
  EXPECT_EQ(run("$prowl plan hold.toml $dirs --out first").status, 0);
  EXPECT_EQ(run("$prowl plan hold.toml $dirs --out second --intervals 7").status, 0);
  const Outcome both = run("$prowl report first second $dirs --out both.html");
  EXPECT_EQ(both.status, 0) << both.error;
  EXPECT_THAT(both.error, HasSubstr("report: both.html, "));
  EXPECT_THAT(both.error, HasSubstr("of two plans"));
  const std::string page = test::read_file(folder_.path() / "both.html");
  EXPECT_THAT(page, HasSubstr("\"other\":{\"directory\":\"second\""));

  const Outcome named = run("$prowl report first second/ $dirs --json && cd second && $prowl report . ../first $dirs");
  EXPECT_EQ(named.status, 0) << named.error;
  EXPECT_THAT(named.error, AllOf(HasSubstr("report: report-first-second.html, "),
                                 HasSubstr("report: ../report-second-first.html, ")));
  EXPECT_EQ(nlohmann::json::parse(named.out).at("written"), nlohmann::json::array({"report-first-second.html"}));
  EXPECT_THAT(test::read_file(folder_.path() / "report-first-second.html"),
              HasSubstr("\"other\":{\"directory\":\"second/\""));
  for (const char* folder : {"first", "second"})
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / folder / "report.html")) << "the report of one plan";

  const Outcome none = run("$prowl report first nowhere $dirs");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.error, HasSubstr("nowhere/plan.json: no such file"));
}

TEST_F(Command, SaysWhatAReportNeeds) {
  const Outcome none = run("$prowl report nowhere");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.error, HasSubstr("nowhere/plan.json: no such file"));
  run("$prowl plan hold.toml $dirs --out out");
  const Outcome nowhere = run("$prowl report out $dirs --out no/such/folder/report.html");
  EXPECT_EQ(nowhere.status, 4);
  folder_.write("out/simulate.csv", "time_s,x\n0,1\n");
  const Outcome other = run("$prowl report out $dirs");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.error, HasSubstr("simulate.csv:1: no column"));
}

TEST_F(Command, PlansWithoutAnybodyListening) {
  for (const char* listener : {"2>&-", "2>/dev/full", "<&- 2>&-"}) {
    const Outcome result = run(std::string("$prowl plan hold.toml $dirs --out out ") + listener);
    EXPECT_EQ(result.status, 0) << listener;
    EXPECT_EQ(plan().at("status"), "converged") << listener;
    EXPECT_EQ(run("$prowl check out $dirs").status, 0) << "no progress in the trajectory, " << listener;
  }
  EXPECT_EQ(run("$prowl plan missing.toml 2>&-").status, 2);
  EXPECT_EQ(run("$prowl plan --nothing 2>/dev/full").status, 2);
}

TEST_F(Command, FailsIfTheResultDoesNotGetThrough) {
  for (const char* arguments : {"robot hyq.toml $dirs", "--help", "--version", "plan --help"}) {
    for (const char* closed : {" >/dev/full", " >&-"}) {
      const Outcome result = run(std::string("$prowl ") + arguments + closed);
      EXPECT_EQ(result.status, 4) << arguments << closed;
      EXPECT_THAT(result.error, StartsWith("prowl: standard output: "));
    }
  }
}

TEST_F(Command, WritesAllFilesBeforeTheResult) {
  const Outcome result = run("$prowl plan hold.toml $dirs --out full --report >/dev/full");
  EXPECT_EQ(result.status, 4) << result.error;
  for (const char* file : {"plan.json", "trajectory.csv", "tracker.bin", "report.html"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "full" / file)) << file;
  }
}

TEST_F(Command, PlansFilesWhoseNamesAreNotUtf8) {
  const Outcome result =
      run("name=$(printf 'caf\\351'); mkdir $name; cp hold.toml hyq.toml $name; "
          "$prowl plan $name/hold.toml $dirs --out out --json && $prowl robot $name/hyq.toml $dirs --json");
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_THAT(plan().at("task_file").at("path").get<std::string>(), HasSubstr("caf\xef\xbf\xbd/hold.toml"));
}

TEST_F(Command, LooksIntoTheCloneThatItWasBuiltIn) {
  const std::string share = "clone/.venv/lib/python3.11/site-packages/cmeel.prefix";
  const Outcome result = run("mkdir -p clone/build/bin " + share + " && ln -s '" PROWL_ROBOTS_DATA "' " + share +
                             "/share && "
                             "cp $prowl clone/build/bin && clone/build/bin/prowl robot hyq.toml");
  EXPECT_EQ(result.status, 0) << result.error;
}

TEST_F(Command, ShowsFramesOfARobotWithoutContacts) {
  const std::string text = test::kHyqFile;
  folder_.write("new.toml", text.substr(0, text.find("contact = [")) + text.substr(text.find("[nominal")));
  const Outcome result = run("$prowl robot new.toml $dirs --frames");
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("\n  lf_foot\n"));
  EXPECT_THAT(result.out, HasSubstr("no contacts"));
  folder_.write("new_task.toml", test::replaced(kHold, "hyq.toml", "new.toml"));
  EXPECT_EQ(run("$prowl plan new_task.toml $dirs --out out").status, 2);
}

TEST_F(Command, PrintsNothingButJsonIfAsked) {
  const Outcome result = run("$prowl plan hold.toml $dirs --out out --json");
  ASSERT_EQ(result.status, 0) << result.error;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("certificate").at("passed"), true);
  EXPECT_EQ(json.at("solver").at("iterations"), plan().at("solver").at("iterations"));
}

TEST_F(Command, PrintsPhasesInPlaceOfPlanning) {
  folder_.write("walk.toml",
                "robot = \"hyq.toml\"\n[gait]\nkind = \"walk\"\nstrides = 1\nstride_s = [2, 3]\n"
                "stride_length_m = 0.1\n");
  const Outcome text = run("$prowl plan walk.toml $dirs --print-phases");
  EXPECT_EQ(text.status, 0) << text.error;
  EXPECT_THAT(text.out, StartsWith("HyQ walk: 9 phases, 46 intervals, 2.9 to 3.85 s\n"));
  EXPECT_THAT(text.out, HasSubstr("stride 1: lh_foot swings"));
  EXPECT_EQ(text.error, "") << "progress of a solve";
  const Outcome json = run("$prowl plan walk.toml $dirs --print-phases --json --intervals 40");
  EXPECT_EQ(nlohmann::json::parse(json.out).at("phases").size(), 9u);
  EXPECT_FALSE(written());

  EXPECT_THAT(run("$prowl plan hold.toml $dirs --print-phases").out,
              StartsWith("HyQ hold: 1 phase, 5 intervals, 2 s\n"));
  EXPECT_EQ(run("$prowl plan hold.toml $dirs --print-phases --out out").status, 2) << "it writes nothing";
}

TEST_F(Command, WritesNothingOnBadInput) {
  folder_.write("bad.toml", test::replaced(kHold, "duration_s", "duration"));
  for (const char* arguments :
       {"bad.toml $dirs", "missing.toml", ". $dirs", "hold.toml $dirs --dt nan", "hold.toml $dirs --max-time 0",
        "hold.toml $dirs --tolerance nan", "hold.toml $dirs --intervals 0", "hold.toml $dirs --dt 1e-9"}) {
    const Outcome result = run(std::string("$prowl plan --out out ") + arguments);
    EXPECT_EQ(result.status, 2) << arguments << result.error;
    EXPECT_FALSE(written()) << arguments;
    EXPECT_THAT(result.error, StartsWith("prowl: ")) << arguments;
    EXPECT_EQ(result.out, "");
  }
  EXPECT_THAT(run("$prowl plan bad.toml $dirs").error,
              StartsWith("prowl: bad.toml:4:1: phase[0].duration: unknown key; did you mean 'duration_s'?"));
  EXPECT_EQ(run("$prowl check missing").status, 2);
  EXPECT_EQ(run("$prowl check hold.toml").error,
            "prowl: hold.toml: this is a file; need the folder that prowl plan wrote\n");
}

TEST_F(Command, LooksAtTheFolderBeforeItSolves) {
  folder_.write("file", "");
  const Outcome result = run("$prowl plan hold.toml $dirs --out file/out");
  EXPECT_EQ(result.status, 4);
  EXPECT_THAT(result.error, Not(HasSubstr("iteration"))) << "a solve for nothing";
  const Outcome nowhere = run("$prowl plan hold.toml $dirs --out /proc/prowl");
  EXPECT_EQ(nowhere.status, 4);
  EXPECT_THAT(nowhere.error, Not(HasSubstr("iteration"))) << "a solve for nothing";
  folder_.write("out/thesis.tex", "years of work");
  EXPECT_EQ(run("$prowl plan hold.toml $dirs --out out").status, 4);
  EXPECT_EQ(test::read_file(folder_.path() / "out/thesis.tex"), "years of work");
}

TEST_F(Command, SaysThatALimitWasReached) {
  const std::string shift = "[[goal]]\ntime_s = 2.0\nbase_displacement_m = [0, 0, -0.1]\n";
  folder_.write("shift.toml", kHold + shift);
  const Outcome result = run("$prowl plan shift.toml $dirs --out out --max-iterations 1");
  EXPECT_EQ(result.status, 6) << result.error;
  EXPECT_EQ(plan().at("status"), "iteration_limit");
  EXPECT_EQ(plan().at("finished"), false);
  EXPECT_EQ(plan().at("good"), false);
  EXPECT_THAT(result.error, Not(HasSubstr("replaces")));
  const Outcome check = run("$prowl check out $dirs");
  EXPECT_EQ(check.status, 6) << "a check does not finish it";
  EXPECT_THAT(check.out, HasSubstr("(as planned): not finished"));
}

TEST_F(Command, SaysThatItReplacesAGoodPlan) {
  EXPECT_EQ(run("$prowl plan hold.toml $dirs --out out").status, 0);
  EXPECT_EQ(plan().at("good"), true);
  EXPECT_THAT(run("$prowl plan hold.toml $dirs --out out --intervals 6").error,
              HasSubstr("note: this replaces an earlier plan that passed, in out"));
}

TEST_F(Command, GoesFromACoarseMeshToAFineOne) {
  const Outcome result = run("$prowl plan hold.toml $dirs --out out --intervals 200");
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_THAT(result.error, HasSubstr("mesh of 13 intervals\n"));
  EXPECT_THAT(result.error, HasSubstr("mesh of 50 intervals\n"));
  EXPECT_THAT(result.error, HasSubstr("mesh of 200 intervals\n"));
  const nlohmann::json solver = plan().at("solver");
  ASSERT_EQ(solver.at("levels").size(), 3u);
  int iterations = 0;
  for (const auto& level : solver.at("levels")) iterations += level.at("iterations").get<int>();
  EXPECT_EQ(solver.at("iterations"), iterations);
  EXPECT_THAT(result.out, HasSubstr(" iterations on 13, 50, 200 intervals"));
}

TEST_F(Command, ChoosesTheMesh) {
  folder_.write("bow.toml", test::replaced(test::kPhase, "intervals = 5\n", "") + kBow);
  const Outcome result = run("$prowl plan bow.toml $dirs --out out --no-gains");
  EXPECT_EQ(result.status, 0) << result.out << result.error;
  EXPECT_THAT(result.out, HasSubstr(" intervals, refined from 20, 2 s;"));
  const Outcome one_mesh = run("$prowl plan bow.toml $dirs --one-mesh");
  EXPECT_EQ(one_mesh.status, 2);
  EXPECT_THAT(one_mesh.error, HasSubstr("one mesh: the task has no intervals; need --intervals"));
  EXPECT_THAT(run("$prowl compare bow.toml $dirs").error,
              HasSubstr(" intervals, with which the trapezoid meets grade draft"));
  EXPECT_THAT(unwrapped(run("$prowl diagnose bow.toml $dirs").out), HasSubstr("the task has a plan, and it passes"));
}

/// Crouching needs steps that differ; its plan is read back with them.
TEST_F(Command, RefinesTheMesh) {
  folder_.write("bow.toml", test::kPhase + kBow);
  const Outcome result = run("$prowl plan bow.toml $dirs --out out --refine");
  EXPECT_EQ(result.status, 0) << result.out << result.error;
  EXPECT_THAT(result.error, HasSubstr("5 intervals, "));
  EXPECT_THAT(result.error, HasSubstr("0 too coarse\n"));
  const nlohmann::json refined = plan();
  const nlohmann::json phase = refined.at("problem").at("phases").at(0);
  EXPECT_GT(phase.at("intervals"), 5);
  EXPECT_EQ(phase.at("shares").size(), phase.at("intervals"));
  EXPECT_EQ(refined.at("certificate").at("grade"), "draft");
  EXPECT_EQ(run("$prowl check out $dirs").status, 0);
  EXPECT_EQ(run("$prowl plan bow.toml $dirs --out out2 --warm-start out --intervals 120 && $prowl simulate out $dirs "
                "--engine rollout")
                .status,
            0);
  const Outcome coarse = run("$prowl plan bow.toml $dirs --out out3 --refine 0.02 --no-gains");
  EXPECT_THAT(coarse.error, HasSubstr(" of 4.0e-03")) << "a tolerance of one's own";
  const Outcome refused = run("$prowl plan bow.toml $dirs --refine certifed");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.error, HasSubstr("certifed is not allowed; need draft, certified or a re-integration error > 0"));
}

TEST_F(Command, TakesThreadsHessianAndTolerance) {
  const Outcome result =
      run("$prowl plan hold.toml $dirs --out out --threads 2 --hessian gauss-newton --tolerance 1e-7");
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_EQ(plan().at("solver").at("tolerance"), 1e-7);
  EXPECT_EQ(plan().at("solver").at("hessian"), "gauss-newton");
  const Outcome refused = run("$prowl plan hold.toml $dirs --out out2 --threads 2 --solver fatrop");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.error, HasSubstr("--threads: Fatrop evaluates one stage at a time"));
  EXPECT_EQ(run("$prowl plan hold.toml $dirs --out out2 --hessian none").status, 2);
}

TEST_F(Command, SaysThatATaskWithoutCostIsLeftToChance) {
  folder_.write("free.toml", kPhase);
  EXPECT_THAT(run("$prowl plan free.toml $dirs --out out").out,
              HasSubstr("  note         without [cost] all motions count as equally good"));
  EXPECT_THAT(run("$prowl plan hold.toml $dirs --out out").out, Not(HasSubstr("without [cost]")));
}

/// The smoothed tips of four cones must not ask for more than the weight.
TEST_F(Command, StandsOnIce) {
  folder_.write("ice.toml", kHold + "[[surface]]\nname = \"ice\"\nfriction = 0.03\n");
  const Outcome result = run("$prowl plan ice.toml $dirs --out out");
  EXPECT_EQ(result.status, 0) << result.out;
}

TEST_F(Command, SaysWhatIsSeldomMeant) {
  folder_.write("glue.toml", kHold + "[[surface]]\nname = \"glue\"\nfriction = 50\n");
  const Outcome result = run("$prowl plan glue.toml $dirs --out out");
  EXPECT_EQ(result.status, 0) << result.out;
  EXPECT_THAT(result.error, HasSubstr("note: surface 'glue' has friction 50; rubber on dry concrete has about 1\n"));
  EXPECT_THAT(run("$prowl diagnose glue.toml $dirs").error, HasSubstr("note: surface 'glue'"));
  EXPECT_THAT(run("$prowl plan hold.toml $dirs --out usual").error, Not(HasSubstr("note:")));
}

TEST_F(Command, StartsFromAPlan) {
  const std::string shift = "[[goal]]\ntime_s = 2.0\nbase_displacement_m = [0.02, 0, -0.05]\n";
  folder_.write("shift.toml", kHold + shift);
  ASSERT_EQ(run("$prowl plan shift.toml $dirs --out first --intervals 80").status, 0);
  // The same from its own solution: nothing is left to find. Then another goal on another mesh.
  const Outcome again = run("$prowl plan shift.toml $dirs --out out --intervals 80 --warm-start first");
  EXPECT_EQ(again.status, 0) << again.error;
  EXPECT_EQ(plan().at("solver").at("warm_start"), "first");
  EXPECT_EQ(plan().at("solver").at("levels").size(), 1u);
  EXPECT_LE(plan().at("solver").at("iterations").get<int>(), 4);
  folder_.write("further.toml", kHold + "[[goal]]\ntime_s = 2.0\nbase_displacement_m = [0.03, 0.01, -0.06]\n");
  const Outcome further = run("$prowl plan further.toml $dirs --out out --intervals 100 --warm-start first");
  EXPECT_EQ(further.status, 0) << further.error;
  EXPECT_THAT(further.out, HasSubstr("started from first\n"));
  EXPECT_EQ(run("$prowl check out $dirs").status, 0);

  folder_.write("two.toml", kHold + "[[phase]]\ncontacts = \"all\"\nduration_s = 1.0\nintervals = 5\n");
  const Outcome other = run("$prowl plan two.toml $dirs --warm-start first");
  EXPECT_EQ(other.status, 2);
  EXPECT_EQ(other.error, "prowl: --warm-start first: the motion to start from has 1 phases, the task 2\n");
  EXPECT_EQ(run("$prowl plan shift.toml $dirs --warm-start nowhere").status, 2);
  folder_.write("three.toml", test::replaced(kHold + shift, "\"all\"", "[\"lf_foot\", \"lh_foot\", \"rf_foot\"]"));
  EXPECT_EQ(run("$prowl plan three.toml $dirs --warm-start first").error,
            "prowl: --warm-start first: the motion to start from has other contacts in phase 1\n");
}

TEST_F(Command, KeepsTheBestIterateOnInterrupt) {
  const std::string shift = "[[goal]]\ntime_s = 2.0\nbase_displacement_m = [0, 0, -0.1]\n";
  folder_.write("shift.toml", kHold + shift);
  // Ctrl-C once the first iteration is reported; 400 intervals take far longer than the signal.
  const Outcome result = run("$at_terminal plan shift.toml $dirs --out out --intervals 400 2>progress & pid=$!; " +
                             test::until(test::kIteration) + "kill -INT $pid; wait $pid");
  EXPECT_EQ(result.status, 130) << result.error;
  ASSERT_TRUE(written());
  EXPECT_EQ(plan().at("status"), "interrupted");
  EXPECT_EQ(plan().at("finished"), false);
  EXPECT_THAT(result.out, HasSubstr("not finished: interrupted"));
}

TEST_F(Command, SaysWhyThereIsNoMotionWithoutTryingOne) {
  folder_.write("far.toml", kHold + "[[goal]]\ntime_s = 2.0\nbase_displacement_m = [0, 0, 1.5]\n");
  const Outcome far = run("$prowl plan far.toml $dirs --out out");
  EXPECT_EQ(far.status, 3) << far.error;
  EXPECT_THAT(unwrapped(far.out), AllOf(HasSubstr("goal 1, phase 'phase 1': "),
                                        HasSubstr("all 4 contacts are out of reach"), HasSubstr("written to out")));
  EXPECT_THAT(far.out, Not(HasSubstr("certificate"))) << "of an initial guess";
  EXPECT_THAT(far.error, Not(HasSubstr("iteration"))) << "a solve for nothing";
  EXPECT_EQ(plan().at("status"), "infeasible");
  EXPECT_EQ(plan().at("finished"), false);
  EXPECT_EQ(plan().at("reasons").size(), 1u) << "the same of four feet is one fact";

  folder_.write("slope.toml", kHold + R"([[surface]]
name = "slope"
normal = [-0.5, 0, 0.8660254]   # 30 degrees
friction = 0.5
[start]
on = "slope"
)");
  const Outcome slope = run("$prowl plan slope.toml $dirs --out out");
  EXPECT_EQ(slope.status, 3) << slope.error;
  EXPECT_THAT(unwrapped(slope.out), HasSubstr("surface 'slope' has 0.5 and needs 0.577"));
  const Outcome check = run("$prowl check out $dirs");
  EXPECT_EQ(check.status, 3) << "a check does not make it feasible";
  EXPECT_THAT(check.out, HasSubstr("(as planned): infeasible"));
}

TEST_F(Command, MakesARobustPlanOrTellsHowRobustItIs) {
  const Outcome robust = run("$prowl plan hold.toml $dirs --out out --robust");
  ASSERT_EQ(robust.status, 0) << robust.error;
  EXPECT_THAT(robust.out, HasSubstr("Robust, to first order, against the disturbances asked for.\n"));
  EXPECT_EQ(plan().at("robustness").at("share"), 1.0);
  EXPECT_EQ(plan().at("overrides").at("robust"), true);
  EXPECT_EQ(run("$prowl check out $dirs").status, 0);

  // No feet bear a base that may weigh anywhere within 40 cm.
  folder_.write("hold.toml", kHold + "[robust]\ncenter_m = 0.2\nbase_position_m = 0.2\n");
  const Outcome less = run("$prowl plan hold.toml $dirs --out out");
  EXPECT_EQ(less.status, 3);
  EXPECT_THAT(unwrapped(less.out), AllOf(HasSubstr(" % of each size; the "), HasSubstr(" leaves least")));
  EXPECT_THAT(less.error, HasSubstr("the plan is good, but not as robust as asked: it is kept"));
  EXPECT_LT(plan().at("robustness").at("share"), 1.0);
  EXPECT_EQ(plan().at("good"), true);
  EXPECT_THAT(run("$prowl check out $dirs").out, HasSubstr(" leaves least"));
  EXPECT_EQ(run("$prowl simulate out $dirs").status, 0);
}

TEST_F(Command, RefusesRobustStridesThatRepeat) {
  folder_.write("hold.toml",
                "robot = \"hyq.toml\"\n[gait]\nkind = \"trot\"\nperiodic = true\nstrides = 1\n"
                "stride_s = 0.8\nstride_length_m = 0.1\nduty_factor = 0.55\n");
  const Outcome refused = run("$prowl plan hold.toml $dirs --robust");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.error, HasSubstr("strides that repeat have no robust plan (--robust)"));
}

}  // namespace
}  // namespace prowl
