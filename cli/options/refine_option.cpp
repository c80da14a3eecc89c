#include "cli/options/refine_option.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/options/shared_options.hpp"

namespace prowl::cli {
namespace {

/// Nullopt for invalid text.
std::optional<MeshTolerance> tolerance_of(const std::string& text) {
  for (const CertificateGrade grade : {CertificateGrade::draft, CertificateGrade::certified}) {
    if (text == to_string(grade)) return mesh_tolerance(grade);
  }
  double reintegration = 0.0;
  const bool is_number = CLI::detail::lexical_cast(text, reintegration) && std::isfinite(reintegration);
  return is_number && reintegration > 0.0 ? std::optional(mesh_tolerance(reintegration)) : std::nullopt;
}

}  // namespace

void add_refine(CLI::App& verb, std::optional<MeshTolerance>& tolerance) {
  const CLI::Validator is_tolerance(
      [](const std::string& text) {
        const char* const needed =
            " is not allowed; need draft, certified or a re-integration error > 0, or nothing after the task";
        return tolerance_of(text) ? std::string() : text + needed;
      },
      "");
  verb.add_option_function<std::string>(
          "--refine", [&tolerance](const std::string& text) { tolerance = tolerance_of(text); },
          "Refine the mesh until its measured errors meet draft (default), certified, or this re-integration error")
      ->expected(0, 1)
      ->default_str(to_string(CertificateGrade::draft))
      ->check(is_tolerance)
      ->type_name("TOL")
      ->group(kMeshOptions);
}

std::string in_words(const RefineRound& round, const MeshTolerance& tolerance) {
  return fmt::format("{} intervals, {} iterations: local error about {:.1e} of {:.1e}; {} too coarse\n",
                     round.intervals, round.iterations, round.error, tolerance.local, round.too_coarse);
}

}  // namespace prowl::cli
