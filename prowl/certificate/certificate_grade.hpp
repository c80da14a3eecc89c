#pragma once

namespace prowl {

/// Grade of a certificate; CertificateLimits contains the limits.
enum class CertificateGrade { failed, draft, certified };

const char* to_string(CertificateGrade grade);

}  // namespace prowl
