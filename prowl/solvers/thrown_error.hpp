#pragma once

#include <exception>
#include <string>

namespace prowl {

/// Within a catch (...): what the exception says.
inline std::string thrown_error() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "stopped by something that is not a std::exception";
  }
}

}  // namespace prowl
