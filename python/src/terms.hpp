#pragma once

#include <map>
#include <string>

#include "bindings.hpp"
#include "prowl/task_file/own_terms.hpp"

namespace prowl::python {

/// A term of one's own in Python, wrapped for nanobind, which has no holder of constant objects.
struct TermObject {
  std::shared_ptr<const Term> term;
};

OwnTerms own_terms(const std::map<std::string, TermObject>& known, bool allow_libraries);

}  // namespace prowl::python
