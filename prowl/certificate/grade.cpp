#include <algorithm>
#include <array>

#include "prowl/certificate/certificate.hpp"

namespace prowl {

const char* to_string(Grade grade) {
  switch (grade) {
    case Grade::certified: return "certified";
    case Grade::draft: return "draft";
    case Grade::failed: break;
  }
  return "failed";
}

bool fails_by_mesh_only(const Certificate& certificate) {
  constexpr std::array kOfTheMesh{"local integration error", "integration error in a second", "re-integration"};
  return std::ranges::all_of(certificate.checks, [&](const CertificateCheck& check) {
    const bool is_of_mesh = std::ranges::find(kOfTheMesh, check.name) != kOfTheMesh.end();
    return check.passed || is_of_mesh;
  });
}

}  // namespace prowl
