#include "prowl/files/atomic_folder.hpp"

#include <gmock/gmock.h>
#include <grp.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <iterator>
#include <thread>
#include <vector>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> kNames = {"a.txt", "b.txt", "c.txt"};

class AtomicFolder : public testing::Test {
 protected:
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }
  test::TempFolder folder_;
  const fs::path out_ = folder_.path() / "out";
};

TEST_F(AtomicFolder, ReplacesFoldersWithinOnlyIfAllInThemIsKnown) {
  const std::set<std::string> names = {"a.txt", "pictures/b.png"};
  folder_.write("out/pictures/b.png", "old");
  folder_.write("out/pictures/mine.txt", "mine");
  EXPECT_THROW(write_folder_atomically(out_, {{"a.txt", "1"}}, names), FileError);
  EXPECT_EQ(test::read_file(out_ / "pictures/mine.txt"), "mine");
  fs::remove(out_ / "pictures/mine.txt");
  fs::create_directory(out_ / "other");
  EXPECT_THROW(write_folder_atomically(out_, {{"a.txt", "1"}}, names), FileError) << "an empty folder of another name";
  fs::remove(out_ / "other");
  write_folder_atomically(out_, {{"a.txt", "1"}}, names);
  EXPECT_FALSE(fs::exists(out_ / "pictures"));
}

TEST_F(AtomicFolder, HoldsExactlyTheNewFiles) {
  write_folder_atomically(out_, {{"a.txt", "1"}, {"b.txt", "2"}}, kNames);
  write_folder_atomically(out_, {{"a.txt", "3"}, {"c.txt", ""}}, kNames);
  EXPECT_EQ(test::read_file(out_ / "a.txt"), "3");
  EXPECT_FALSE(fs::exists(out_ / "b.txt"));
  EXPECT_TRUE(fs::exists(out_ / "c.txt"));
  EXPECT_EQ(entries(), 1u) << "something is left beside it";
}

TEST_F(AtomicFolder, MakesTheFoldersAbove) {
  write_folder_atomically(folder_.path() / "x/y/z/", {{"a.txt", "1"}}, kNames);
  EXPECT_EQ(test::read_file(folder_.path() / "x/y/z/a.txt"), "1");
}

/// As another prowl does that tries whether it could write there.
TEST_F(AtomicFolder, MakesTheFoldersAboveAgainThatAnotherProcessTakesAway) {
  std::atomic<bool> done = false;
  std::thread other([&] {
    while (!done) {
      ::rmdir((folder_.path() / "x/y").c_str());
      ::rmdir((folder_.path() / "x").c_str());
      std::this_thread::sleep_for(std::chrono::microseconds(50));  // else nobody else gets to make them
    }
  });
  for (int i = 0; i < 300; ++i) {
    EXPECT_NO_THROW(write_folder_atomically(folder_.path() / "x/y/z", {{"a.txt", "1"}}, kNames)) << i;
    fs::remove_all(folder_.path() / "x/y/z");
  }
  done = true;
  other.join();
}

mode_t permissions(const fs::path& path) {
  struct stat status = {};
  ::stat(path.c_str(), &status);
  return status.st_mode & 07777;
}

TEST_F(AtomicFolder, KeepsThePermissionsOfWhatItReplaces) {
  write_folder_atomically(out_, {{"a.txt", "1"}}, kNames);
  ::chmod(out_.c_str(), 02750);
  ::chmod((out_ / "a.txt").c_str(), 0600);
  write_folder_atomically(out_, {{"a.txt", "2"}, {"b.txt", "2"}}, kNames);
  EXPECT_EQ(permissions(out_), 02750u);
  EXPECT_EQ(permissions(out_ / "a.txt"), 0600u);
  write_file_atomically(out_ / "a.txt", "3");
  EXPECT_EQ(permissions(out_ / "a.txt"), 0600u);
}

TEST_F(AtomicFolder, LeavesFoldersWithOtherFilesAlone) {
  folder_.write("out/a.txt", "1");
  folder_.write("out/thesis.tex", "years of work");
  EXPECT_THROW(write_folder_atomically(out_, {{"a.txt", "2"}}, kNames), FileError);
  EXPECT_EQ(test::read_file(out_ / "a.txt"), "1");
  EXPECT_EQ(test::read_file(out_ / "thesis.tex"), "years of work");
}

/// Hours of work, and then somebody opens a file there in an editor.
TEST_F(AtomicFolder, KeepsWhatCannotTakeItsPlaceAndOfThatTheLatest) {
  folder_.write("out/.a.txt.swp", "of an editor");
  const fs::path kept = out_.string() + ".prowl-" + std::to_string(::getpid()) + ".new";
  for (const std::string text : {"1", "2", "3"}) {
    try {
      write_folder_atomically(out_, {{"a.txt", text}}, kNames);
      FAIL() << "was replaced";
    } catch (const FileError& error) {
      EXPECT_TRUE(std::string(error.what()).ends_with("are in " + kept.string())) << error.what();
    }
    EXPECT_EQ(test::read_file(kept / "a.txt"), text);
  }
  EXPECT_EQ(entries(), 2u) << "something else is left beside it";
}

/// As another prowl does that exchanges a folder in it.
TEST_F(AtomicFolder, LooksAgainWhereFoldersInItComeAndGo) {
  const std::set<std::string> names = {"a.txt", "pictures/b.png"};
  folder_.write("out/a.txt", "1");
  std::atomic<bool> done = false;
  std::thread other([&] {
    while (!done) {
      for (const char* name : {"out/.prowl-1-0.new", "out/pictures"}) {
        ::mkdir((folder_.path() / name).c_str(), 0777);
        ::rmdir((folder_.path() / name).c_str());
      }
    }
  });
  for (int i = 0; i < 2000; ++i) EXPECT_NO_THROW(check_replaceable(out_, names)) << i;
  done = true;
  other.join();
}

TEST_F(AtomicFolder, KeepsTheOldContentIfTheDiskIsFull) {
  write_folder_atomically(out_, {{"a.txt", "old"}, {"b.txt", "old too"}}, kNames);
  // The largest file that this process may write stands for the space on the disk.
  rlimit before;
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small = {.rlim_cur = 1000, .rlim_max = before.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(write_folder_atomically(out_, {{"a.txt", "new"}, {"b.txt", std::string(2000, 'x')}}, kNames), FileError);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(test::read_file(out_ / "a.txt"), "old");
  EXPECT_EQ(test::read_file(out_ / "b.txt"), "old too");
  EXPECT_EQ(entries(), 1u) << "a half-written folder is left";
}

TEST_F(AtomicFolder, RefusesFoldersThatCannotBeWritten) {
  folder_.write("file", "");
  EXPECT_THROW(check_replaceable(folder_.path() / "file", kNames), FileError);
  EXPECT_THROW(check_replaceable(folder_.path() / "file/out", kNames), FileError);
  EXPECT_NO_THROW(check_replaceable(folder_.path() / "new/out", kNames));
  EXPECT_EQ(entries(), 1u) << "the trial left something behind";
}

TEST_F(AtomicFolder, FindsOutByTrial) {
  EXPECT_THROW(check_replaceable("/proc/prowl", kNames), FileError) << "writable for root by its permissions";
  EXPECT_THROW(check_replaceable(folder_.path() / "new" / std::string(256, 'x'), kNames), FileError);
  EXPECT_EQ(entries(), 0u) << "the trial left something behind";
  const fs::path longest = folder_.path() / "new" / std::string(255, 'x');
  EXPECT_NO_THROW(check_replaceable(longest, kNames));
  EXPECT_EQ(entries(), 0u);
  write_folder_atomically(longest, {{"a.txt", "1"}}, kNames);
  EXPECT_EQ(test::read_file(longest / "a.txt"), "1");
}

TEST_F(AtomicFolder, RefusesFoldersWithoutPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(folder_.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(check_replaceable(out_, kNames), FileError);
  EXPECT_THROW(write_folder_atomically(out_, {{"a.txt", "1"}}, kNames), FileError);
  fs::permissions(folder_.path(), fs::perms::owner_all);
}

/// Nobody's, who is in no group but that of this name: what belongs to root's group is another's.
class AsNobody : public AtomicFolder {
 protected:
  static constexpr uid_t kNobody = 65534;

  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "needs root, to be somebody else";
    write_folder_atomically(out_, {{"a.txt", "1"}, {"b.txt", "1"}}, kNames);
    for (const fs::path& path : {out_, out_ / "a.txt", out_ / "b.txt"}) ASSERT_EQ(::chown(path.c_str(), kNobody, 0), 0);
    ::chmod((out_ / "a.txt").c_str(), 0600);
    ::chmod((out_ / "b.txt").c_str(), 0664);
    fs::permissions(folder_.path(), fs::perms::all);
  }

  void write_as_nobody() const {
    std::vector<gid_t> groups(static_cast<std::size_t>(::getgroups(0, nullptr)));
    ASSERT_GE(::getgroups(static_cast<int>(groups.size()), groups.data()), 0);
    ASSERT_EQ(::setgroups(0, nullptr), 0);
    ASSERT_EQ(::setegid(kNobody), 0);
    ASSERT_EQ(::seteuid(kNobody), 0);
    EXPECT_NO_THROW(write_folder_atomically(out_, {{"a.txt", "2"}, {"b.txt", "2"}}, kNames));
    ASSERT_EQ(::seteuid(0), 0);
    ASSERT_EQ(::setegid(::getgid()), 0);
    ASSERT_EQ(::setgroups(groups.size(), groups.data()), 0);
    EXPECT_EQ(test::read_file(out_ / "a.txt"), "2");
  }
};

/// Who may not keep the group must not open it to another: what the group may is then no more than what all may.
TEST_F(AsNobody, IsNoLessPrivateWhereTheGroupCannotBeKept) {
  write_as_nobody();
  EXPECT_EQ(permissions(out_ / "a.txt"), 0600u);
  EXPECT_EQ(permissions(out_ / "b.txt"), 0644u);
}

/// A project's folder hands its group on to what is made in it, whoever is in that group.
TEST_F(AsNobody, KeepsWhatTheGroupMayWhereTheFolderAboveGivesTheGroup) {
  ASSERT_EQ(::chmod(folder_.path().c_str(), 02777), 0);
  ASSERT_EQ(::chmod(out_.c_str(), 0775), 0);
  write_as_nobody();
  EXPECT_EQ(permissions(out_), 0775u);
  EXPECT_EQ(permissions(out_ / "a.txt"), 0600u);
  EXPECT_EQ(permissions(out_ / "b.txt"), 0664u);
}

/// Its owner, without write permission for it, may rename it all the same.
TEST_F(AtomicFolder, RefusesAFolderThatIsReadOnly) {
  write_folder_atomically(out_, {{"a.txt", "1"}}, kNames);
  fs::permissions(out_, fs::perms::owner_read | fs::perms::owner_exec);
  const uid_t user = ::geteuid();
  constexpr uid_t kNobody = 65534;
  if (user == 0) {  // root may write everywhere
    fs::permissions(folder_.path(), fs::perms::all);
    ASSERT_EQ(::chown(out_.c_str(), kNobody, static_cast<gid_t>(-1)), 0);
    ASSERT_EQ(::seteuid(kNobody), 0);
  }
  EXPECT_THROW(check_replaceable(out_, kNames), FileError);
  EXPECT_THROW(write_folder_atomically(out_, {{"a.txt", "2"}}, kNames), FileError);
  ASSERT_EQ(::seteuid(user), 0);
  fs::permissions(out_, fs::perms::owner_all);
  EXPECT_EQ(test::read_file(out_ / "a.txt"), "1");
}

/// The user gave no other name than this one.
TEST_F(AtomicFolder, NamesAFolderThatCannotBeMadeAsTheUserDoes) {
  const fs::path locked = folder_.path() / "locked";
  fs::create_directory(locked);
  fs::permissions(locked, fs::perms::owner_read | fs::perms::owner_exec);
  const uid_t user = ::geteuid();
  constexpr uid_t kNobody = 65534;
  if (user == 0) {  // root may write everywhere
    fs::permissions(folder_.path(), fs::perms::all);
    ASSERT_EQ(::chown(locked.c_str(), kNobody, static_cast<gid_t>(-1)), 0);
    ASSERT_EQ(::seteuid(kNobody), 0);
  }
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  };
  const std::string made = message([&] { check_replaceable(locked / "x", kNames); }),
                    written = message([&] { write_folder_atomically(locked / "x", {{"a.txt", "2"}}, kNames); }),
                    inside = message([&] { check_writable(locked); });
  ASSERT_EQ(::seteuid(user), 0);
  fs::permissions(locked, fs::perms::owner_all);
  const std::string begin = (locked / "x").string() + ": cannot be made: no permission to write in " + locked.string();
  EXPECT_THAT(made, testing::StartsWith(begin));
  EXPECT_THAT(written, testing::StartsWith(begin));
  EXPECT_THAT(inside, testing::StartsWith(locked.string() + ": cannot write here: "));
}

TEST_F(AtomicFolder, ReplacesThePlaceThatALinkPointsTo) {
  write_folder_atomically(folder_.path() / "real", {{"a.txt", "1"}}, kNames);
  fs::create_directory_symlink(folder_.path() / "real", out_);
  write_folder_atomically(out_, {{"a.txt", "2"}}, kNames);
  EXPECT_TRUE(fs::is_symlink(out_));
  EXPECT_EQ(test::read_file(folder_.path() / "real/a.txt"), "2");
}

}  // namespace
}  // namespace prowl
