#include "prowl/certificate/mesh_errors.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::Pointwise;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Certificate with_errors(const std::vector<double>& local, double reintegration, double second) {
  Certificate certificate;
  for (const double error : local) {
    certificate.interval_errors.push_back({.error = error, .where = "", .reintegration = reintegration});
  }
  certificate.checks = {{"local integration error", *std::ranges::max_element(local)},
                        {"integration error in a second", second},
                        {"re-integration", reintegration}};
  return certificate;
}

TEST(ErrorParts, AreTheLargerOfBothErrors) {
  const MeshTolerance tolerance{.local = 1e-4, .second = 1.0, .reintegration = 5e-4};
  EXPECT_THAT(error_parts(with_errors({2e-4, 1e-5}, 3e-4, 0.0), tolerance), Pointwise(DoubleNear(1e-12), {2.0, 0.6}));
  EXPECT_THAT(error_parts(with_errors({2e-4, 1e-5}, 3e-3, 0.0), tolerance), Pointwise(DoubleNear(1e-12), {6.0, 6.0}));
  EXPECT_THAT(error_parts(with_errors({std::nan(""), kInfinity}, 0.0, 0.0), tolerance), Each(kInfinity));
}

/// A mesh that meets the sum over a second is not made coarser than the sum allows: it would be split again.
TEST(ErrorParts, KeepTheSumWhereMeshesMerge) {
  const MeshTolerance tolerance{.local = 1e-4, .second = 3e-3, .reintegration = 5e-4};
  const int n = 100;
  const double e = 0.9 * tolerance.second / n;
  const double c = e / error_parts(with_errors(std::vector<double>(n, e), 0.0, n * e), tolerance)[0];
  EXPECT_NEAR(n * std::cbrt(e / c) * c, tolerance.second, 1e-12);
  EXPECT_LT(c, 0.5 * tolerance.local);
  EXPECT_EQ(error_parts(with_errors({0.0, 0.0}, 0.0, 0.0), tolerance)[0], 0.0);
}

/// Where only the sum is too large, intervals have to be off by less than the worst is, so that the sum of equal errors
/// is right: n intervals of error e become n (e/c)^(1/3) of error c.
TEST(ErrorParts, KeepTheSumOverASecond) {
  const MeshTolerance tolerance{.local = 1e-4, .second = 3e-3, .reintegration = 5e-4};
  const double e = 0.8e-4;
  const int n = 100;
  const std::vector<double> parts = error_parts(with_errors(std::vector<double>(n, e), 0.0, n * e), tolerance);
  const double c = e / parts[0];
  EXPECT_NEAR(n * std::cbrt(e / c) * c, tolerance.second, 1e-12);
  // As long as intervals are too coarse themselves, the sum tells nothing of what is left of it.
  EXPECT_NEAR(error_parts(with_errors({2e-4, e}, 0.0, 1.0), tolerance)[1], 0.8, 1e-12);
}

TEST(MeshTolerance, IsWhatTheGradesAskFor) {
  const MeshTolerance draft = mesh_tolerance(CertificateGrade::draft),
                      certified = mesh_tolerance(CertificateGrade::certified);
  EXPECT_EQ(draft.local, CertificateLimits::integration_error_draft);
  EXPECT_EQ(certified.second, CertificateLimits::second_error_certified);
  for (const MeshTolerance& of_grade : {draft, certified}) {
    const MeshTolerance same = mesh_tolerance(of_grade.reintegration);
    EXPECT_DOUBLE_EQ(same.local, of_grade.local);
    EXPECT_EQ(same.second, of_grade.second);
  }
  EXPECT_DOUBLE_EQ(mesh_tolerance(5e-5).local, 1e-5);
  EXPECT_EQ(mesh_tolerance(5e-5).second, draft.second);
}

TEST(FailsByMeshOnly, IsWhenAFinerMeshMayDo) {
  Certificate certificate = with_errors({1.0}, 1.0, 1.0);  // none of the three checks passes
  EXPECT_TRUE(fails_by_mesh_only(certificate));
  certificate.checks.push_back({.name = "joint torque", .unit = "-", .where = "", .passed = true});
  EXPECT_TRUE(fails_by_mesh_only(certificate));
  certificate.checks.back().passed = false;
  EXPECT_FALSE(fails_by_mesh_only(certificate)) << "that stays on any mesh";
}

}  // namespace
}  // namespace prowl
