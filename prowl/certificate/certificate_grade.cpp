#include "prowl/certificate/certificate_grade.hpp"

namespace prowl {

const char* to_string(CertificateGrade grade) {
  switch (grade) {
    case CertificateGrade::certified: return "certified";
    case CertificateGrade::draft: return "draft";
    case CertificateGrade::failed: break;
  }
  return "failed";
}

}  // namespace prowl
