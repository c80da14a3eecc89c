#include "prowl/files/atomic_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <regex>
#include <vector>

#include "prowl/error.hpp"

namespace prowl {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& action, int error) {
  throw FileError(fmt::format("{}: {}: {}", path.string(), action, std::strerror(error)));
}

/// Open file or folder, closed at the end.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : path_(path), number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (number_ < 0) fail(path, "cannot open", errno);
  }
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write_all(const std::string& text) const {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t count = ::write(number_, text.data() + done, text.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail(path_, "cannot write", errno);
      done += static_cast<std::size_t>(count);
    }
  }
  void sync() const {
    if (::fsync(number_) != 0) fail(path_, "cannot write to disk", errno);
  }
  /// Takes permissions and group of the old file or folder, if it exists, to keep it as private.
  void be_as_private_as(const fs::path& old) const {
    constexpr mode_t kPermissions = 07777;
    struct stat was = {}, is = {};
    if (::stat(old.c_str(), &was) != 0 || ::fstat(number_, &is) != 0) return;
    mode_t permissions = was.st_mode & kPermissions;
    // This user cannot set that group: its members get the permissions of everyone.
    if (is.st_gid != was.st_gid && ::fchown(number_, static_cast<uid_t>(-1), was.st_gid) != 0) {
      permissions = (permissions & ~static_cast<mode_t>(S_ISGID | S_IRWXG)) | ((permissions & S_IRWXO) << 3);
    }
    const bool is_same = ::fstat(number_, &is) == 0 && (is.st_mode & kPermissions) == permissions;
    if (!is_same && ::fchmod(number_, permissions) != 0)
      fail(path_, "cannot copy the permissions of the old one", errno);
  }

 private:
  fs::path path_;
  int number_;
};

/// Writes and syncs a file that will replace `old`, which need not exist.
void write_new(const fs::path& file, const std::string& text, const fs::path& old) {
  const Descriptor descriptor(file, O_WRONLY | O_CREAT | O_EXCL);
  descriptor.be_as_private_as(old);
  descriptor.write_all(text);
  descriptor.sync();
}

constexpr std::chrono::hours kLeftoverAge{1};  // far longer than any write, on any machine that sees the folder

/// ".prowl-4711-0.new": a SiblingFolder, maybe of a killed process.
bool is_sibling_name(const std::string& name) {
  static const std::regex pattern(R"(\.prowl-[0-9]+-[0-9]+\.new)");
  return std::regex_match(name, pattern);
}

/// Removes sibling folders of killed processes.
void remove_leftovers(const fs::path& folder) {
  std::error_code error, ignored;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!is_sibling_name(entry->path().filename().string())) continue;
    const auto written = fs::last_write_time(entry->path(), ignored);
    if (!ignored && fs::file_time_type::clock::now() - written > kLeftoverAge) fs::remove_all(entry->path(), ignored);
  }
}

/// Another process that tests if it can write may remove the empty folders above at any moment.
constexpr int kMostAttempts = 1000;

enum class FolderAbove { has_to_exist, is_made };

/// New folder beside `folder`, removed at the end with its content: the new one, or after the exchange the old one.
/// Only this user may open it if `folder` exists or single files are replaced: the old content may be private.
class SiblingFolder {
 public:
  /// `shown`: name for messages of the folder, or of its parent if that has to exist; "" for `folder`.
  explicit SiblingFolder(const fs::path& folder, FolderAbove above, const fs::path& shown = {}) {
    const fs::path parent = folder.parent_path();
    remove_leftovers(parent);
    std::error_code error;
    const bool is_new = above == FolderAbove::is_made && !fs::exists(folder, error);
    const mode_t mode = is_new ? 0777 : 0700;
    for (int attempt = 0, taken = 0;; ++attempt) {
      if (above == FolderAbove::is_made) make_folder(parent);
      path_ = parent / fmt::format(".prowl-{}-{}.new", ::getpid(), taken);
      if (::mkdir(path_.c_str(), mode) == 0) return;
      const bool is_gone = errno == ENOENT && above == FolderAbove::is_made;
      if ((errno != EEXIST && !is_gone) || attempt == kMostAttempts) fail_to_make(folder, above, shown, errno);
      if (errno == EEXIST) ++taken;
    }
  }
  ~SiblingFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  SiblingFolder(const SiblingFolder&) = delete;
  SiblingFolder& operator=(const SiblingFolder&) = delete;
  const fs::path& path() const { return path_; }
  /// Takes permissions and group of the old folder, and syncs.
  void finish(const fs::path& old) const {
    const Descriptor descriptor(path_, O_RDONLY | O_DIRECTORY);
    descriptor.be_as_private_as(old);
    descriptor.sync();
  }

 private:
  [[noreturn]] static void fail_to_make(const fs::path& folder, FolderAbove above, const fs::path& shown, int error) {
    const fs::path name = shown.empty() ? folder : shown;
    if (above == FolderAbove::has_to_exist)
      fail(shown.empty() ? folder.parent_path() : shown, "cannot write here", error);
    const std::string reason =
        error == EACCES || error == EPERM || error == EROFS
            ? fmt::format("no permission to write in {} ({})", folder.parent_path().string(), std::strerror(error))
            : std::string(std::strerror(error));
    throw FileError(fmt::format("{}: cannot be made: {}", name.string(), reason));
  }

  /// Does nothing if a folder above vanishes meanwhile: the next attempt makes it again.
  static void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error && error != std::errc::no_such_file_or_directory) {
      throw FileError(fmt::format("{}: cannot make this folder: {}", folder.string(), error.message()));
    }
  }

  fs::path path_;
};

/// Renames `fresh` to `folder`; an old folder of that name becomes `fresh`.
void exchange(const fs::path& fresh, const fs::path& folder) {
  if (::rename(fresh.c_str(), folder.c_str()) == 0) return;  // there was none, or an empty one
  if (errno != ENOTEMPTY && errno != EEXIST) fail(folder, "cannot put the new folder in place", errno);
  if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno != EINVAL && errno != ENOSYS) fail(folder, "cannot exchange with the new folder", errno);
  // Some network file systems cannot exchange: rename twice, and undo the first if the second fails. A kill between
  // them leaves the old content in `old`.
  const fs::path old = fmt::format("{}.prowl-{}.old", folder.string(), ::getpid());
  if (::rename(folder.c_str(), old.c_str()) != 0) fail(folder, "cannot move the old folder away", errno);
  if (::rename(fresh.c_str(), folder.c_str()) != 0) {
    const int error = errno;
    ::rename(old.c_str(), folder.c_str());
    fail(folder, "cannot put the new folder in place", error);
  }
  if (::rename(old.c_str(), fresh.c_str()) != 0) fail(old, "cannot remove the old folder", errno);
}

/// Throws FileError if no other folder can take this one's name: a mount point, or another user's folder where only
/// owners may rename (as in /tmp). A folder that vanishes meanwhile is fine.
void check_exchangeable(const fs::path& path) {
  struct stat here = {}, above = {};
  if (::stat(path.c_str(), &here) != 0) {
    if (errno == ENOENT) return;
    fail(path, "cannot read this folder", errno);
  }
  if (::faccessat(AT_FDCWD, path.c_str(), W_OK | X_OK, AT_EACCESS) != 0 && errno != ENOENT)
    fail(path, "cannot be replaced", errno);
  if (::stat(path.parent_path().c_str(), &above) != 0) fail(path.parent_path(), "cannot read this folder", errno);
  struct statx more = {};
  const bool is_known = ::statx(AT_FDCWD, path.c_str(), 0, STATX_BASIC_STATS, &more) == 0 &&
                        (more.stx_attributes_mask & STATX_ATTR_MOUNT_ROOT) != 0;
  const bool is_mounted = is_known ? (more.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0 : here.st_dev != above.st_dev;
  if (is_mounted) {
    throw FileError(fmt::format("{}: this is a mount point, and prowl replaces the whole folder; need a folder in it",
                                path.string()));
  }
  const uid_t user = ::geteuid();
  const bool is_others = user != 0 && here.st_uid != user && above.st_uid != user;
  if ((above.st_mode & S_ISVTX) != 0 && is_others) fail(path, "cannot be replaced: it belongs to another user", EPERM);
}

/// Makes the folder or, if it exists, another beside it, with the missing ones above, and removes them again:
/// permissions do not reveal /proc, names too long, or a full disk. A kill may leave an empty folder.
void try_to_make(const fs::path& path, const fs::path& shown) {
  std::error_code error;
  std::vector<fs::path> missing;  // from the inside out
  for (fs::path above = path.parent_path(); !fs::exists(above, error) && above != above.parent_path();) {
    missing.push_back(above);
    above = above.parent_path();
  }
  const auto remove_missing = [&missing] {
    for (const fs::path& folder : missing) ::rmdir(folder.c_str());
  };
  try {
    const SiblingFolder trial(path, FolderAbove::is_made, shown);
    if (fs::exists(path, error)) {
      trial.finish(path);
    } else if (::rename(trial.path().c_str(), path.c_str()) == 0) {
      ::rmdir(path.c_str());
    } else if (errno != ENOTEMPTY && errno != EEXIST) {  // another process may have made it meanwhile
      fail(path, "cannot put the new folder in place", errno);
    }
  } catch (const FileError&) {
    remove_missing();
    throw;
  }
  remove_missing();
}

/// A file with one of these names, a folder on its path, a folder of a killed process, or something that vanished.
bool is_own(const std::string& name, const fs::directory_entry& entry, const std::set<std::string>& own_names) {
  for (const fs::path& part : fs::path(name)) {
    if (is_sibling_name(part.string())) return true;
  }
  std::error_code ignored;
  if (entry.is_regular_file(ignored)) return own_names.contains(name);
  const fs::file_type type = entry.symlink_status(ignored).type();
  if (type == fs::file_type::not_found) return true;
  if (type != fs::file_type::directory) return false;  // links are not followed
  const auto inside = own_names.lower_bound(name + "/");
  return inside != own_names.end() && inside->starts_with(name + "/");
}

/// First name found in the folder that is not own; "" if there is none.
std::string not_own(const fs::path& folder, const std::set<std::string>& own_names) {
  for (int attempt = 0;; ++attempt) {
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
      const std::string name = entry->path().lexically_relative(folder).generic_string();
      if (!is_own(name, *entry, own_names)) return name;
    }
    if (!error) return "";
    if (error != std::errc::no_such_file_or_directory ||
        attempt == kMostAttempts) {  // otherwise a folder in it vanished meanwhile
      throw FileError(fmt::format("{}: cannot read this folder: {}", folder.string(), error.message()));
    }
    if (!fs::exists(folder, error)) return "";
  }
}

/// Throws FileError unless `path` is missing, or a replaceable folder with only these names. `shown`: its name for
/// messages.
void check_old(const fs::path& path, const fs::path& shown, const std::set<std::string>& own_names) {
  std::error_code error;
  if (!fs::exists(path, error)) return;
  if (!fs::is_directory(path, error)) throw FileError(fmt::format("{}: not a folder", shown.string()));
  if (const std::string name = not_own(path, own_names); !name.empty()) {
    throw FileError(
        fmt::format("{}: cannot be replaced: it contains {}, which prowl does not write there; need another folder",
                    shown.string(), name));
  }
  check_exchangeable(path);
}

}  // namespace

fs::path real_path(const fs::path& folder) {
  std::error_code error;
  fs::path path;
  int attempt = 0;
  do {
    path = fs::weakly_canonical(fs::absolute(folder), error);
  } while (error == std::errc::no_such_file_or_directory && ++attempt < kMostAttempts);
  if (error) throw FileError(fmt::format("{}: {}", folder.string(), error.message()));
  return path.has_filename() ? path : path.parent_path();
}

void check_replaceable(const fs::path& folder, const std::set<std::string>& own_names) {
  const fs::path path = real_path(folder);
  check_old(path, folder, own_names);
  try_to_make(path, folder);
}

void write_folder_atomically(const fs::path& folder, const std::map<std::string, std::string>& files,
                             const std::set<std::string>& own_names) {
  const fs::path path = real_path(folder);
  const SiblingFolder fresh(path, FolderAbove::is_made, folder);
  for (const auto& [name, text] : files) write_new(fresh.path() / name, text, path / name);
  try {
    check_old(path, folder, own_names);
    fresh.finish(path);
    exchange(fresh.path(), path);
  } catch (const FileError& failure) {  // all is written, maybe after hours of work
    const fs::path kept = fmt::format("{}.prowl-{}.new", path.string(), ::getpid());
    try {
      exchange(fresh.path(), kept);  // replaces what an earlier run kept
    } catch (const FileError&) {
      throw failure;
    }
    throw FileError(fmt::format("{}; the new files are in {}", failure.what(), kept.string()));
  }
  Descriptor(path.parent_path(), O_RDONLY | O_DIRECTORY).sync();
}

void check_writable(const fs::path& folder) {
  const SiblingFolder trial(real_path(folder) / "file", FolderAbove::has_to_exist, folder);
}

void write_files_atomically(const fs::path& folder, const std::map<std::string, std::string>& files) {
  const fs::path target_folder = real_path(folder);
  std::error_code error;
  for (const auto& [name, text] : files) {  // with enough rights, a rename would replace /dev/null
    const fs::file_status old = fs::status(target_folder / name, error);
    if (fs::exists(old) && !fs::is_regular_file(old))
      throw FileError(fmt::format("{}: not a file", (target_folder / name).string()));
  }
  const SiblingFolder fresh(target_folder / "file", FolderAbove::has_to_exist, folder);
  for (const auto& [name, text] : files) write_new(fresh.path() / name, text, target_folder / name);
  for (const auto& [name, text] : files) {
    const fs::path target = target_folder / name;
    if (::rename((fresh.path() / name).c_str(), target.c_str()) != 0)
      fail(target, "cannot put the new file in place", errno);
  }
  Descriptor(target_folder, O_RDONLY | O_DIRECTORY).sync();
}

void write_file_atomically(const fs::path& file, const std::string& text) {
  const fs::path path = real_path(file);
  write_files_atomically(path.parent_path(), {{path.filename().string(), text}});
}

}  // namespace prowl
