#include "cli/verbs/plan_tracker.hpp"

#include "prowl/error.hpp"
#include "prowl/simulation/simulation.hpp"

namespace prowl::cli {

Tracker read_tracker(const std::filesystem::path& directory, const MotionProblem& problem) {
  if (!std::filesystem::exists(directory / "tracker.bin")) {
    throw InputError((directory / "tracker.bin").string() +
                     ": no such file; prowl plan writes it for a good plan, except with --no-gains");
  }
  try {
    Tracker tracker = Tracker::read((directory / "tracker.bin").string());
    check_fit(problem, tracker);
    return tracker;
  } catch (const TrackerError& error) {
    throw InputError(error.what());
  }
}

}  // namespace prowl::cli
