#pragma once

#include "prowl/files/text_file.hpp"

namespace prowl {

/// Throws InputError "file:line:column: ..." if the text nests so deeply that reading it would overflow the stack:
/// toml++ limits brackets to 256 within each other, but not the parts of a dotted key, each of which is a table in a
/// table. In no way a check of syntax: right up to the first mistake in it, beyond which nothing is read.
void check_toml_shape(const SourceText& source);

constexpr int kDeepestToml = 16;  ///< brackets within each other, and parts of a key; our own files have 3 of each

}  // namespace prowl
