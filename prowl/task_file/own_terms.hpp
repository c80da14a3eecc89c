#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "prowl/terms/term.hpp"

namespace prowl {

/// Terms of one's own by the names that task files use.
using OwnTermMap = std::map<std::string, std::shared_ptr<const Term>>;

/// Where a task file finds terms of one's own.
struct OwnTerms {
  OwnTermMap known = {};
  bool allows_libraries = false;  ///< whether code of a library that the file names may run
};

/// Begins the function that defines the terms of a shared library. Its suffix is the version of the interface Term.
///
///   PROWL_OWN_TERMS(terms) { terms["clear of the post"] = prowl::own_term<3, 1>(...); }
#define PROWL_OWN_TERMS(terms) extern "C" void prowl_own_terms_1(prowl::OwnTermMap& terms)

/// The terms of a shared library, which stays loaded. Throws InputError with the loader's reason.
OwnTermMap own_terms_of(const std::filesystem::path& library);

}  // namespace prowl
