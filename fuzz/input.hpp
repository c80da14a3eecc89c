#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "prowl/error.hpp"

namespace prowl::fuzz {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Every answer but these is a fault: a reader takes what it is given, or says with an Error what is wrong with it.
template <class Read>
void takes_or_refuses(const Read& read) {
  try {
    read();
  } catch (const Error&) {
  }
}

}  // namespace prowl::fuzz
