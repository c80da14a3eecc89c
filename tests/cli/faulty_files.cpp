// For LD_PRELOAD: files that cannot be written. FAULTY_FILES="N KILL" ends the process at its Nth operation that
// changes files (write in the middle of it, all others before they begin), FAULTY_FILES="N 28" makes that and all later
// ones fail with this errno. With FAULTY_ONCE=1 only that one does. With FAULTY_PATH=TEXT only files with TEXT in their
// path count. Standard streams never do. FAULTY_RENAMEAT2=1: a file system that cannot exchange folders.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

int operations = 0;

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

std::string path_of(int descriptor) {
  char path[4096] = {};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  return ::readlink(link.c_str(), path, sizeof path - 1) > 0 ? path : "";
}

enum class Fault { none, kill, error };

Fault fault(const std::string& path) {
  const char* const plan = std::getenv("FAULTY_FILES");
  const char* const only = std::getenv("FAULTY_PATH");
  const bool is_coverage = path.ends_with(".gcda");  // counts of lines, written at the end of a build with coverage
  if (!plan || is_coverage || (only && path.find(only) == std::string::npos)) return Fault::none;
  char* rest = nullptr;
  const int at = static_cast<int>(std::strtol(plan, &rest, 10));
  ++operations;
  if (operations < at) return Fault::none;
  if (std::getenv("FAULTY_ONCE") && operations > at) return Fault::none;
  if (std::strcmp(rest, " KILL") == 0) return operations == at ? Fault::kill : Fault::none;
  errno = std::atoi(rest);
  return Fault::error;
}

/// Whether the operation is to fail; does not return from a kill.
bool fails(const std::string& path) {
  const Fault now = fault(path);
  if (now == Fault::kill) ::raise(SIGKILL);
  return now == Fault::error;
}

}  // namespace

extern "C" {

int mkdir(const char* path, mode_t mode) {
  return fails(path) ? -1 : next<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = (flags & O_CREAT) ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  if ((flags & O_CREAT) && fails(path)) return -1;
  return next<int (*)(const char*, int, ...)>("open")(path, flags, mode);
}

ssize_t write(int descriptor, const void* data, size_t size) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  struct stat status;
  if (descriptor <= STDERR_FILENO || ::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode))
    return real(descriptor, data, size);
  const Fault now = fault(path_of(descriptor));
  if (now == Fault::error) return -1;
  if (now == Fault::kill) {
    real(descriptor, data, size / 2);
    ::raise(SIGKILL);
  }
  return real(descriptor, data, size);
}

int fsync(int descriptor) { return fails(path_of(descriptor)) ? -1 : next<int (*)(int)>("fsync")(descriptor); }

int rmdir(const char* path) { return fails(path) ? -1 : next<int (*)(const char*)>("rmdir")(path); }

int rename(const char* from, const char* to) {
  return fails(to) ? -1 : next<int (*)(const char*, const char*)>("rename")(from, to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  if (std::getenv("FAULTY_RENAMEAT2")) {
    errno = EINVAL;
    return -1;
  }
  if (fails(to)) return -1;
  return next<int (*)(int, const char*, int, const char*, unsigned)>("renameat2")(from_folder, from, to_folder, to,
                                                                                  flags);
}
}
