#include "prowl/solvers/foreign/snopt_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>
#include <type_traits>

namespace prowl {

namespace {

const std::string kNoFile = "/dev/null";

}  // namespace

SnoptLibrary::SnoptLibrary(const std::string& file) : handle_(::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (!handle_) {
    const char* const reason = ::dlerror();
    why_unusable_ =
        fmt::format("SNOPT is commercial and does not come with Prowl; your own library cannot be loaded: {}",
                    reason ? reason : file);
    return;
  }
  const auto resolve = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(::dlsym(handle_, name));
    return function != nullptr;
  };
  const auto require = [&](auto& function, const char* name) {
    if (!resolve(function, name) && !why_unusable_) {
      why_unusable_ = fmt::format(
          "{}: function {} is missing; need SNOPT 7 with its C interface, snopt-interface 2.1 or later", file, name);
    }
  };
  require(set, "f_snset");
  require(needed_memory, "f_snmema");
  require(solve, "f_snopta");
  require(end, "f_snend");
  if (!resolve(initialise_with_paths_, "f_sninitx")) require(initialise_with_name_, "f_sninitf");
}

SnoptLibrary::~SnoptLibrary() {
  if (handle_) ::dlclose(handle_);
}

void SnoptLibrary::initialise(int iw[], int leniw, double rw[], int lenrw) const {
  if (initialise_with_paths_) {
    const auto length = static_cast<int>(kNoFile.size());
    initialise_with_paths_(kNoFile.data(), length, kNoFile.data(), length, iw, leniw, rw, lenrw);
  } else {
    initialise_with_name_("", 0, 0, iw, leniw, rw, lenrw);
  }
}

}  // namespace prowl
