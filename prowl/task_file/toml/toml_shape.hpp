#pragma once

#include "prowl/files/text_file.hpp"

namespace prowl {

/// Throws InputError "file:line:column: ..." if nesting would overflow the stack of the reader:
/// toml++ limits nested brackets to 256, but not the parts of a dotted key, which are nested
/// tables. Not a syntax check: valid up to the first syntax error, where reading stops.
void check_toml_shape(const SourceText& source);

constexpr int kDeepestToml = 16;  ///< nested brackets, and parts of a key; shipped files have 3 of each

}  // namespace prowl
