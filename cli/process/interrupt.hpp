#pragma once

#include <atomic>

namespace prowl::cli {

/// From now on the first Ctrl-C (or SIGTERM, or the end of the terminal but under nohup) sets the flag, which stops a
/// solver within an iteration and a sweep after the simulations that are running; the second ends the process at once
/// with status 130, but for a second end of the terminal. A pipe that nobody reads any more ends nothing.
const std::atomic<bool>& catch_interrupts();

/// Whether SIGHUP came: then nobody reads what is printed.
bool is_terminal_gone();

}  // namespace prowl::cli
