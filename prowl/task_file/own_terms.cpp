#include "prowl/task_file/own_terms.hpp"

#include <exception>

#include "prowl/error.hpp"
#include "prowl/files/shared_library.hpp"

namespace prowl {

OwnTermMap own_terms_of(const std::filesystem::path& library) {
  using Define = void (*)(OwnTermMap&);
  const auto define = reinterpret_cast<Define>(load_function(
      library, "prowl_own_terms_1", library.string() + ": no library of terms; build it with PROWL_OWN_TERMS"));
  OwnTermMap terms;
  try {
    define(terms);
  } catch (const std::exception& error) {
    throw InputError(library.string() + ": " + error.what());
  }
  return terms;
}

}  // namespace prowl
