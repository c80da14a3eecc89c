#pragma once

namespace prowl {

/// Grade of a certificate; CertificateLimits contains the limits.
enum class Grade { failed, draft, certified };

const char* to_string(Grade grade);

}  // namespace prowl
