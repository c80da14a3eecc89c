#include "prowl/certificate/mesh_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace prowl {
namespace {

using Limits = CertificateLimits;

constexpr const char* kLocal = "local integration error";
constexpr const char* kSecond = "integration error in a second";
constexpr const char* kReintegration = "re-integration";

double worst(const Certificate& certificate, const char* name) {
  const CertificateCheck* const check = certificate.find(name);
  return check ? check->worst : 0.0;
}

}  // namespace

MeshTolerance mesh_tolerance(CertificateGrade grade) {
  if (grade == CertificateGrade::certified) {
    return {Limits::integration_error_certified, Limits::second_error_certified, Limits::reintegration_certified};
  }
  return {Limits::integration_error_draft, Limits::second_error_draft, Limits::reintegration_draft};
}

MeshTolerance mesh_tolerance(double reintegration) {
  const MeshTolerance of_grade = mesh_tolerance(
      reintegration <= Limits::reintegration_certified ? CertificateGrade::certified : CertificateGrade::draft);
  return {reintegration * of_grade.local / of_grade.reintegration, of_grade.second, reintegration};
}

MeshTolerance mesh_errors(const Certificate& certificate) {
  return {worst(certificate, kLocal), worst(certificate, kSecond), worst(certificate, kReintegration)};
}

bool fails_by_mesh_only(const Certificate& certificate) {
  constexpr std::array<std::string_view, 3> kOfTheMesh{kLocal, kSecond, kReintegration};
  return std::ranges::all_of(certificate.checks, [&](const CertificateCheck& check) {
    const bool is_of_mesh = std::ranges::find(kOfTheMesh, check.name) != kOfTheMesh.end();
    return check.passed || is_of_mesh;
  });
}

std::vector<double> error_parts(const Certificate& certificate, const MeshTolerance& tolerance) {
  const auto part_of = [&](const IntervalError& of, double local) {
    const double part = std::max(of.error / local, of.reintegration / tolerance.reintegration);
    return std::isfinite(of.error) && std::isfinite(of.reintegration) ? part : std::numeric_limits<double>::infinity();
  };
  const MeshTolerance errors = mesh_errors(certificate);
  // The sum counts only once every interval is short enough by itself.
  const bool is_for_the_sum =
      errors.local <= tolerance.local && errors.reintegration <= tolerance.reintegration && errors.second > 0.0;
  const double for_the_sum = errors.local * std::pow(tolerance.second / errors.second, 1.5);
  const double local = is_for_the_sum ? std::min(tolerance.local, for_the_sum) : tolerance.local;
  std::vector<double> parts;
  for (const IntervalError& interval : certificate.interval_errors) parts.push_back(part_of(interval, local));
  return parts;
}

}  // namespace prowl
