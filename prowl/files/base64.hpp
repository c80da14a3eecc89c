#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace prowl {

// Numbers as text that a browser reads without parsing them: their little-endian bytes in base64 (RFC 4648), padded.

std::string base64(std::span<const float> numbers);
std::string base64(std::span<const std::uint32_t> numbers);

}  // namespace prowl
