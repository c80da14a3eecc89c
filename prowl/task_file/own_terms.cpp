#include "prowl/task_file/own_terms.hpp"

#include "prowl/files/shared_library.hpp"

namespace prowl {

OwnTermMap own_terms_of(const std::filesystem::path& library) {
  using Define = void (*)(OwnTermMap&);
  const auto define = reinterpret_cast<Define>(load_function(
      library, "prowl_own_terms_1", library.string() + ": no library of terms; build it with PROWL_OWN_TERMS"));
  OwnTermMap terms;
  define(terms);
  return terms;
}

}  // namespace prowl
