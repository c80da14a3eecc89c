#pragma once

#include <filesystem>
#include <string>

namespace prowl {

/// A function of a shared library, which is loaded at the first call and stays: Prowl starts without what nobody asked
/// for. `library`: its path, or its name for the loader to search. Throws InputError with `remedy` and the loader's
/// reason if the library, or one that it needs, is not installed.
void* load_function(const std::filesystem::path& library, const char* function, const std::string& remedy);

}  // namespace prowl
