// A wrong plan stays wrong on any mesh: faults spread so thin that each interval passes by itself.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/certificate/certificate_cases.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Limits = CertificateLimits;
using test::Case;
using test::failed_checks;
using test::find;
using test::Names;
using test::standing;

/// HyQ that stands for one second with all torques times `factor`, and claims not to move.
Case standing_with_torques(double factor, int intervals) {
  Case c = standing(test::hyq(), intervals);
  for (TrajectoryPoint& node : c.trajectory.nodes) node.tau *= factor;
  return c;
}

TEST(CertificateMesh, TorquesThatAreTooSmallByATenThousandthFail) {
  const Case c = standing_with_torques(0.9999, 200);
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_LT(find(certificate, "local integration error").worst, 0.3 * Limits::integration_error_draft);
  EXPECT_EQ(failed_checks(certificate), Names{"integration error in a second"});
}

TEST(CertificateMesh, TorquesThatAreTooSmallFailOnAFineMesh) {
  const Case c = standing_with_torques(0.999, 1000);
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_LT(find(certificate, "local integration error").worst, Limits::integration_error_draft);
  EXPECT_LT(find(certificate, "re-integration").worst, Limits::reintegration_draft);
  EXPECT_EQ(failed_checks(certificate), Names{"integration error in a second"});
  EXPECT_EQ(certificate.grade, CertificateGrade::failed);
}

TEST(CertificateMesh, TorquesThatAreATouchTooSmallAreNotCertified) {
  const Case c = standing_with_torques(0.99999, 1000);
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_LT(find(certificate, "local integration error").worst, Limits::integration_error_certified);
  EXPECT_LT(find(certificate, "re-integration").worst, Limits::reintegration_certified);
  EXPECT_GT(find(certificate, "integration error in a second").worst, Limits::second_error_certified);
  EXPECT_EQ(certificate.grade, CertificateGrade::draft);
}

TEST(CertificateMesh, TheErrorInASecondDoesNotDependOnTheMesh) {
  const Case coarse = standing_with_torques(0.999, 50), fine = standing_with_torques(0.999, 200);
  const Certificate on_coarse = certify(coarse.discrete, coarse.trajectory);
  const Certificate on_fine = certify(fine.discrete, fine.trajectory);
  EXPECT_NEAR(find(on_coarse, "local integration error").worst / find(on_fine, "local integration error").worst, 4.0,
              1e-6);
  const double total = find(on_fine, "integration error in a second").worst;
  EXPECT_GT(total, 1e-3);
  EXPECT_NEAR(find(on_coarse, "integration error in a second").worst / total, 1.0, 1e-6);
}

TEST(CertificateMesh, ABaseThatSlipsByLessThanADefectAtEveryNodeFails) {
  Case c = standing(test::hyq(), 200);
  for (std::size_t k = 0; k < c.trajectory.nodes.size(); ++k) {
    c.trajectory.nodes[k].q(0) += 0.98e-6 * static_cast<double>(k);
  }
  const Certificate certificate = certify(c.discrete, c.trajectory);
  EXPECT_LT(find(certificate, "defect").worst, Limits::defect);
  EXPECT_EQ(failed_checks(certificate), Names{"total defect"});
  EXPECT_NEAR(find(certificate, "total defect").worst, 200 * 0.98e-6, 1e-6);
  EXPECT_EQ(find(certificate, "total defect").where, "base x");
}

TEST(CertificateMesh, ReintegrationTellsWhichIntervalIsOff) {
  Case c = standing(test::hyq(), 50);
  c.trajectory.nodes[20].tau *= 0.99;
  const Certificate certificate = certify(c.discrete, c.trajectory);
  const double worst = find(certificate, "re-integration").worst;
  ASSERT_EQ(certificate.interval_errors.size(), 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    const double error = certificate.interval_errors[i].reintegration;
    if (i == 19 || i == 20) {
      EXPECT_GT(error, 1e-5) << i;
      EXPECT_LE(error, worst) << i;
    } else {
      EXPECT_LT(error, 1e-8) << i;
    }
  }
  EXPECT_EQ(std::max(certificate.interval_errors[19].reintegration, certificate.interval_errors[20].reintegration),
            worst);
}

TEST(CertificateMesh, AGoodMotionPassesWithRoomToItsTotals) {
  const Case draft = test::crouching(test::hyq(), 160), certified = test::crouching(test::hyq(), 400);
  const Certificate of_draft = certify(draft.discrete, draft.trajectory);
  const Certificate of_certified = certify(certified.discrete, certified.trajectory);
  EXPECT_LT(3.0 * find(of_draft, "integration error in a second").worst, Limits::second_error_draft);
  EXPECT_LT(3.0 * find(of_certified, "integration error in a second").worst, Limits::second_error_certified);
  EXPECT_LT(3.0 * find(of_certified, "re-integration").worst, Limits::reintegration_certified);
}

TEST(CertificateMesh, TheSignOfAQuaternionDoesNotMatter) {
  Case c = test::crouching(test::hyq(), 100);
  const Certificate before = certify(c.discrete, c.trajectory);
  for (std::size_t k = 0; k < c.trajectory.nodes.size(); k += 2) c.trajectory.nodes[k].q.segment<4>(3) *= -1.0;
  const Certificate after = certify(c.discrete, c.trajectory);
  ASSERT_EQ(before.checks.size(), after.checks.size());
  for (std::size_t i = 0; i < before.checks.size(); ++i) {
    EXPECT_NEAR(before.checks[i].worst, after.checks[i].worst, 1e-12) << before.checks[i].name;
  }
}

}  // namespace
}  // namespace prowl
