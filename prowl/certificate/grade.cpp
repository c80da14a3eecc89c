#include "prowl/certificate/grade.hpp"

namespace prowl {

const char* to_string(Grade grade) {
  switch (grade) {
    case Grade::certified: return "certified";
    case Grade::draft: return "draft";
    case Grade::failed: break;
  }
  return "failed";
}

}  // namespace prowl
