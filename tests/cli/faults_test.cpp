// Kills, full disks and folders that cannot be written: what was there before stays whole, and is told of.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "command.hpp"
#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

constexpr int kKilled = 128 + 9;
const std::string kFaulty = "LD_PRELOAD='" PROWL_FAULTY_FILES "' ";

/// HyQ stands, on 5 intervals or on 6: `out` holds one of two plans, which `old` and `other` have for comparison.
class Faults : public test::Command {
 protected:
  void SetUp() override {
    ASSERT_EQ(
        run("$prowl plan hold.toml $dirs --out old && $prowl plan hold.toml $dirs --intervals 6 --out other").status,
        0);
    ASSERT_EQ(run("cp -r old out").status, 0);
  }
  std::string plan_other() const { return "$prowl plan hold.toml $dirs --intervals 6 --out out "; }
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  std::string read(const std::string& name) const { return test::read_file(path(name)); }
  static nlohmann::json without_times(const std::string& plan) {
    const auto is_no_time = [](int, nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
      return event != nlohmann::json::parse_event_t::key ||
             (parsed != "seconds" && parsed != "cpu_seconds" && parsed != "evaluation");
    };
    return nlohmann::json::parse(plan, is_no_time, false);  // what is torn is `discarded`, which equals nothing
  }

  /// Which of the two plans `out` holds, if it is one of them to the last byte (but for the times in plan.json).
  std::string held() const {
    const std::string text = read("out/plan.json");
    for (const std::string& plan : {std::string("old"), std::string("other")}) {
      const bool same = std::ranges::all_of(std::vector{"trajectory.csv", "tracker.bin"}, [&](const char* name) {
        return read("out/" + std::string(name)) == read(plan + "/" + name);
      });
      if (same && without_times(text) == without_times(read(plan + "/plan.json"))) return plan;
    }
    return "torn";
  }
  int leftovers() const {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
      count += entry.path().filename().string().starts_with(".prowl-");
    return count;
  }
};

TEST_F(Faults, AKillAtAnyOperationLeavesAWholePlan) {
  int kills = 0;
  for (int n = 1;; ++n) {
    run("rm -rf out .prowl-*; cp -r old out");
    const Outcome result = run("FAULTY_FILES='" + std::to_string(n) + " KILL' " + kFaulty + plan_other());
    if (result.status == 0) break;
    ASSERT_EQ(result.status, kKilled) << n << ": " << result.error;
    ASSERT_THAT(held(), AnyOf("old", "other")) << "killed at operation " << n;
    ++kills;
  }
  EXPECT_GE(kills, 12) << "folder, three files opened, written and synced, folders synced, exchanged";
  EXPECT_EQ(held(), "other");
}

/// ENOSPC, EIO, EROFS: from the nth operation on nothing can be written.
TEST_F(Faults, ADiskThatFailsAtAnyOperationLeavesAWholePlanAndIsToldOf) {
  for (const int error : {ENOSPC, EIO, EROFS}) {
    int failures = 0;
    for (int n = 1; n < 100; n += error == ENOSPC ? 1 : 4) {
      run("rm -rf out; cp -r old out");
      const Outcome result =
          run("FAULTY_FILES='" + std::to_string(n) + " " + std::to_string(error) + "' " + kFaulty + plan_other());
      if (result.status == 0) break;
      ASSERT_EQ(result.status, 4) << n << ": " << result.error;
      EXPECT_THAT(result.error, HasSubstr(std::strerror(error))) << n;
      EXPECT_THAT(held(), AnyOf("old", "other")) << n;
      EXPECT_EQ(leftovers(), 0) << n;
      ++failures;
    }
    EXPECT_GE(failures, 3);
  }
}

/// All is written, and only the last step fails: the new plan stays under a name that the message tells.
TEST_F(Faults, WhatCannotBePutInPlaceIsKept) {
  int kept = 0;
  for (int n = 1;; ++n) {
    run("rm -rf out out.prowl-*; cp -r old out");
    const Outcome result = run("FAULTY_ONCE=1 FAULTY_FILES='" + std::to_string(n) + " " + std::to_string(EBUSY) + "' " +
                               kFaulty + plan_other());
    if (result.status == 0) break;
    ASSERT_EQ(result.status, 4) << n << ": " << result.error;
    EXPECT_EQ(leftovers(), 0) << n;
    if (result.error.find("the new files are in ") == std::string::npos) continue;
    ++kept;
    EXPECT_EQ(held(), "old") << n;
    ASSERT_EQ(run("rm -rf out; mv out.prowl-*.new out").status, 0) << n;
    EXPECT_EQ(held(), "other") << n;
  }
  EXPECT_GT(kept, 0);
}

/// Where folders cannot be exchanged: two renames.
TEST_F(Faults, AKillBetweenTwoRenamesLosesNothing) {
  const Outcome works = run("FAULTY_RENAMEAT2=1 " + kFaulty + plan_other());
  EXPECT_EQ(works.status, 0) << works.error;
  EXPECT_EQ(held(), "other");
  EXPECT_EQ(leftovers(), 0);
  bool was_between = false;
  for (int n = 1;; ++n) {
    run("rm -rf out .prowl-* out.prowl-*; cp -r old out");
    const Outcome result =
        run("FAULTY_RENAMEAT2=1 FAULTY_FILES='" + std::to_string(n) + " KILL' " + kFaulty + plan_other());
    if (result.status == 0) break;
    if (!fs::exists(path("out"))) {
      was_between = true;
      ASSERT_EQ(run("mv out.prowl-*.old out").status, 0) << "the old plan is under a name that tells";
    }
    ASSERT_THAT(held(), AnyOf("old", "other")) << n;
  }
  EXPECT_TRUE(was_between) << "no kill came between the renames, so the test checks little";
}

TEST_F(Faults, AKillAtAnyOperationOnACheckpointLeavesNoneOrAWholeOne) {
  const std::string command = plan_other() + "--checkpoint so_far --checkpoint-every 0";
  int empty = 0, whole = 0;
  for (int n = 1;; ++n) {
    run("rm -rf out so_far .prowl-*; cp -r old out");
    const Outcome result = run("FAULTY_FILES='" + std::to_string(n) + " KILL' " + kFaulty + command);
    if (result.status == 0) break;
    ASSERT_EQ(result.status, kKilled) << n << ": " << result.error;
    if (fs::exists(path("so_far"))) {
      const bool is_empty = fs::is_empty(path("so_far"));
      ++(is_empty ? empty : whole);
      if (!is_empty) EXPECT_NO_THROW(read_plan(path("so_far"), test::test_search())) << n;
    }
    EXPECT_EQ(run(command).status, 0) << n << ": what is left is in the way";
  }
  EXPECT_EQ(empty, 1) << "the trial before the solve, and none after";
  EXPECT_GT(whole, 0);
}

TEST_F(Faults, WhatAKillLeavesIsNobodyElsesIfTheOldWasPrivate) {
  ASSERT_EQ(
      run("chmod 700 out; umask 022; FAULTY_PATH=plan.json FAULTY_FILES='2 KILL' " + kFaulty + plan_other()).status,
      kKilled);
  EXPECT_EQ(run("stat -c %a .prowl-*.new out").out, "700\n700\n");
  EXPECT_EQ(held(), "old");
}

/// 20 kills; PROWL_KILLS=200 for more. Checkpoints are written all the time, so that many kills meet a write.
TEST_F(Faults, AKillAtARandomMomentLeavesWholePlansAndCheckpoints) {
  const char* const asked = std::getenv("PROWL_KILLS");
  const int kills = asked ? std::atoi(asked) : 20;
  const std::string command = plan_other() + "--checkpoint so_far --checkpoint-every 0";
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run(command).status, 0);
  const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::mt19937 random(1);
  int killed = 0, in_a_write = 0, checkpoints = 0;
  for (int i = 0; i < 20 * kills && killed < kills; ++i) {
    run("rm -rf out so_far .prowl-*; cp -r old out");
    const double moment = std::uniform_real_distribution<>(0.0, whole)(random);
    const Outcome result = run("timeout -s KILL " + std::to_string(moment) + " " + command);
    ASSERT_THAT(result.status, AnyOf(0, kKilled)) << result.error;
    if (result.status == 0) continue;
    ++killed;
    in_a_write += leftovers() > 0;
    ASSERT_THAT(held(), AnyOf("old", "other")) << "killed after " << moment << " s";
    if (!fs::exists(path("so_far")) || fs::is_empty(path("so_far"))) continue;  // it was tried whether it can be made
    ++checkpoints;
    const PlanRecord record = read_plan(path("so_far"), test::test_search());
    EXPECT_EQ(record.plan.result.status, SolveStatus::interrupted);
  }
  EXPECT_EQ(killed, kills);
  EXPECT_GT(checkpoints, 0);
  RecordProperty("in_a_write", in_a_write);
  std::cout << killed << " kills, " << in_a_write << " of them in the midst of a write, " << checkpoints
            << " after a checkpoint\n";
}

TEST_F(Faults, LeftoversOfAKillAreInNobodysWayAndGoInTheEnd) {
  folder_.write("out/.prowl-4711-0.new/file", "half a repo");
  folder_.write(".prowl-4711-0.new/plan.json", "{");
  folder_.write(".prowl-mine/plan.json", "{");
  EXPECT_EQ(run(plan_other()).status, 0) << "half a report of an earlier process";
  EXPECT_TRUE(fs::exists(path(".prowl-4711-0.new"))) << "somebody may be writing it";
  fs::last_write_time(path(".prowl-4711-0.new"), fs::file_time_type::clock::now() - std::chrono::hours(2));
  EXPECT_EQ(run(plan_other()).status, 0);
  EXPECT_FALSE(fs::exists(path(".prowl-4711-0.new")));
  EXPECT_TRUE(fs::exists(path(".prowl-mine/plan.json")));
}

TEST_F(Faults, ExportsAreReplacedTogether) {
  if (!test::kHasPython) GTEST_SKIP() << "the Python package writes them";
  const std::string command = "$prowl export out $dirs --format csv,json ";
  ASSERT_EQ(run(command).status, 0);
  const std::string before = read("out/exports/motion.csv"), json = read("out/exports/motion.json");
  const auto with = [&](int n, const std::string& fault) {
    return run("FAULTY_FILES='" + std::to_string(n) + " " + fault + "' FAULTY_PATH=/out/ " + kFaulty + command +
               "--rate 50");
  };
  int faults = 0;
  for (int n = 1; n < 9; ++n) {
    const Outcome full = with(n, std::to_string(ENOSPC));
    EXPECT_EQ(full.status, 4) << n;
    EXPECT_THAT(full.error, HasSubstr("No space left on device"));
    EXPECT_EQ(read("out/exports/motion.csv"), before) << n;
    EXPECT_EQ(read("out/exports/motion.json"), json) << n;
    faults += full.status == 4;
  }
  EXPECT_EQ(leftovers(), 0);
  EXPECT_EQ(with(6, "KILL").status, kKilled);
  EXPECT_EQ(read("out/exports/motion.csv"), before);
}

/// The solve goes on: hours of work are worth more than a copy of them.
TEST_F(Faults, ACheckpointThatCannotBeWrittenIsANote) {
  const Outcome result = run("FAULTY_FILES='4 28' FAULTY_PATH=/checkpoints/ " + kFaulty + plan_other() +
                             "--checkpoint checkpoints/so_far --checkpoint-every 0");
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_THAT(result.error, HasSubstr("note: no checkpoint written, planning continues: "));
  EXPECT_THAT(result.error, HasSubstr("No space left on device"));
  EXPECT_EQ(held(), "other");
  EXPECT_EQ(leftovers(), 0);
  const Outcome early =
      run("FAULTY_FILES='1 30' FAULTY_PATH=/none/ " + kFaulty + plan_other() + "--checkpoint none/so_far");
  EXPECT_EQ(early.status, 4) << "before the solve it is an error";
  EXPECT_THAT(early.error, Not(HasSubstr("iteration")));
}

TEST_F(Faults, AFolderThatVanishesIsMadeAgain) {
  const Outcome result = run("mkdir gone; $prowl plan hold.toml $dirs --out gone/out 2>progress & pid=$!; " +
                             test::until(test::kIteration) + "rm -rf gone; wait $pid");
  EXPECT_EQ(result.status, 0) << read("progress");
  EXPECT_TRUE(fs::exists(path("gone/out/plan.json")));
}

/// A rename would put a file in place of the device, for root.
TEST_F(Faults, ADeviceIsNoPlaceForAFile) {
  const Outcome result = run("mknod device c 1 3 2>/dev/null || mkfifo device; $prowl report out $dirs --out device");
  EXPECT_EQ(result.status, 4);
  EXPECT_THAT(result.error, HasSubstr("device: not a file"));
  EXPECT_FALSE(fs::is_regular_file(path("device")));
  EXPECT_EQ(leftovers(), 0);
}

/// File systems of their own, which takes the right to mount them.
TEST_F(Faults, ARealDiskThatIsFullOrReadOnly) {
  const auto mounted = [&](const std::string& script) {
    return run("mkdir -p disk; unshare -m sh -c \"mount -t tmpfs -o size=8m none disk && " + script + "\"");
  };
  if (mounted("true").status != 0) GTEST_SKIP() << "needs root, or the right to mount";
  const std::string plan = "$prowl plan hold.toml $dirs --intervals 6 --out disk/out";
  const Outcome mount = mounted("$prowl plan hold.toml $dirs --out disk; echo status \\$?");
  EXPECT_THAT(mount.out, HasSubstr("status 4\n"));
  EXPECT_THAT(mount.error, AllOf(HasSubstr("this is a mount point"), Not(HasSubstr("iteration"))));
  const std::string compare =
      "cmp old/trajectory.csv disk/out/trajectory.csv && cmp old/tracker.bin disk/out/tracker.bin && cmp old/plan.json "
      "disk/out/plan.json";
  const Outcome full = mounted("cp -r old disk/out && dd if=/dev/zero of=disk/rest bs=4k 2>/dev/null; " + plan +
                               "; echo status \\$?; " + compare + " && ls -A disk");
  EXPECT_THAT(full.out, HasSubstr("status 4\nout\nrest\n")) << full.error;
  EXPECT_THAT(full.error, HasSubstr("No space left on device"));
  const Outcome fixed = mounted("cp -r old disk/out && mount -o remount,ro none disk && " + plan +
                                "; echo status \\$?; " + compare + " && ls -A disk");
  EXPECT_THAT(fixed.out, HasSubstr("status 4\nout\n")) << fixed.error;
  EXPECT_THAT(fixed.error, HasSubstr("Read-only file system"));
}

}  // namespace
}  // namespace prowl
