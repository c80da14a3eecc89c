#pragma once

#include <exception>
#include <string>

namespace prowl {

/// Within a catch (...): what the exception says.
inline std::string what_was_thrown() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "stopped by something that is not a std::exception";
  }
}

}  // namespace prowl
