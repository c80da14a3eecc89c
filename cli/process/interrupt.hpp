#pragma once

#include <atomic>

namespace prowl::cli {

/// Installs handlers. The first Ctrl-C, SIGTERM or hang-up (except under nohup) sets the flag,
/// which stops a solver within an iteration and a sweep after its running simulations. The second
/// exits at once with status 130 (a second hang-up does not). A closed pipe stops nothing.
const std::atomic<bool>& catch_interrupts();

/// True after SIGHUP: nobody reads the output.
bool is_terminal_gone();

}  // namespace prowl::cli
