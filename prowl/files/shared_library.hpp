#pragma once

#include <string>

namespace prowl {

/// A function of a shared library, which is loaded at the first call and stays: Prowl starts without what nobody asked
/// for. Throws InputError with `remedy` and the loader's reason if the library, or one that it needs, is not installed.
void* load_function(const std::string& library, const char* function, const std::string& remedy);

}  // namespace prowl
