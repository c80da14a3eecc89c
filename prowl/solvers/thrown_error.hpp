#pragma once

#include <exception>
#include <string>

namespace prowl {

/// Message of the current exception; call within a catch block.
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
