// tracker.bin, as it is, and with the payload's length and checksum put right: by chance no mutation has those. What is
// taken is used, too.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "input.hpp"
#include "prowl/tracker/file_format.hpp"
#include "prowl/tracker/tracker.hpp"

namespace {

using namespace prowl;

void use(const Tracker& tracker) {
  const int nu = tracker.plan().nu();
  Eigen::VectorXd q = tracker.plan().q.col(0), v = tracker.plan().v.col(0), tau(nu);
  for (const double part : {-1.0, 0.0, 0.3, 1.0, 2.0}) {
    tracker.torque(tracker.start() + part * (tracker.end() - tracker.start()), q, v, tau);
    if (!tau.allFinite()) std::abort();
  }
}

/// By way of a file in memory: Tracker::read takes a path.
void read(const std::string& bytes) {
  static const int file = ::memfd_create("tracker.bin", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (::ftruncate(file, 0) != 0 || ::pwrite(file, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    std::abort();
  try {
    use(Tracker::read(path));
  } catch (const TrackerError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes = fuzz::text_of(data, size);
  read(bytes);
  if (size < tracker_file::kHeaderBytes) return 0;
  const std::uint64_t payload = size - tracker_file::kHeaderBytes;
  const std::uint64_t checksum = tracker_file::checksum(bytes.data() + tracker_file::kHeaderBytes, payload);
  std::memcpy(bytes.data() + tracker_file::kHeaderBytes - 2 * sizeof(payload), &payload, sizeof(payload));
  std::memcpy(bytes.data() + tracker_file::kHeaderBytes - sizeof(checksum), &checksum, sizeof(checksum));
  read(bytes);
  return 0;
}
