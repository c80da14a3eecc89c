#pragma once

namespace prowl {

/// Of a certificate, as CertificateLimits tell them apart.
enum class Grade { failed, draft, certified };

const char* to_string(Grade grade);

}  // namespace prowl
