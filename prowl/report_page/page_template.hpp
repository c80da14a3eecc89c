#pragma once

#include <string>

namespace prowl {

/// `file`: a standalone page. The other two are served by a command, and listen to its events.
enum class PageState { file, solving, solved };

/// `page`, built from report/, with `json` in place of its placeholder; the content cannot become markup or script. A
/// served page may connect to its server, a file to nothing. Throws FileError if the page is no template.
std::string filled_page(const std::string& page, const std::string& json, bool is_served);

}  // namespace prowl
