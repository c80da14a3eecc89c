#pragma once

// Internal: shows MuJoCo.
#include <mujoco/mujoco.h>

#include <mutex>

namespace prowl {

/// By default MuJoCo writes warnings to a file in the working directory. Process-wide.
inline void silence_mujoco() {
  static std::once_flag once;
  std::call_once(once, [] { mju_setLogHandler([](const mjLogMessage*) {}); });
}

}  // namespace prowl
