#include "plan_tracker.hpp"

#include "prowl/error.hpp"

namespace prowl::cli {

Tracker read_tracker(const std::filesystem::path& directory) {
  try {
    return Tracker::read((directory / "tracker.bin").string());
  } catch (const TrackerError& error) {
    throw InputError(error.what());
  }
}

}  // namespace prowl::cli
