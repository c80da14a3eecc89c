// The table of checks on screens of all widths.
#include "screen/check_table.hpp"

#include <gmock/gmock.h>

#include <sstream>

namespace prowl {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

const std::vector<CertificateCheck> kChecks = {
    {"contact drift", 1.234e-5, 1e-3, "m", 0.1, "lf_foot", true, 1e-3},
    {"friction cone", -12.3, 8.51, "N", 1.25, "rh_foot", true, 8.51},
    {"local integration error", 1.84e-5, 1e-4, "", 0.2, "velocity of RR_calf_joint", true, 1e-6},
    {"joint torque", 1.79, 1.001, "of limit", 0.125, "arm_right_4_joint", false, 1.001}};

std::string table(CheckColumn fourth, std::size_t columns = kAnyWidth) {
  std::vector<const CertificateCheck*> checks;
  for (const CertificateCheck& check : kChecks) checks.push_back(&check);
  return check_table(checks, fourth, columns);
}

TEST(CheckTable, ShowsAllWhereThereIsRoom) {
  EXPECT_THAT(table(CheckColumn::used),
              AllOf(ContainsRegex("contact drift +1.23e-05 m +0.001 +1 % +lf_foot +pass\n"),
                    ContainsRegex("friction cone +-12.3 N +8.51 +0 % +rh_foot +pass\n"),
                    ContainsRegex("error +1.84e-05 +0.0001 +18 % +velocity of RR_calf_joint +draft\n"),
                    ContainsRegex("joint torque +1.79 +1 +179 % +arm_right_4_joint +FAIL\n")));
  EXPECT_THAT(table(CheckColumn::time), ContainsRegex("drift +1.23e-05 m +0.001 +0.100 s +lf_foot +pass\n"));
}

TEST(CheckTable, FitsTheScreen) {
  for (const CheckColumn fourth : {CheckColumn::used, CheckColumn::time}) {
    for (std::size_t columns = 120; columns >= 40; --columns) {
      const std::string text = table(fourth, columns);
      std::istringstream lines(text);
      std::size_t row = 0;
      for (std::string line; std::getline(lines, line); ++row) {
        EXPECT_LE(line.size(), columns) << text;
        if (row == 0) continue;
        const CertificateCheck& check = kChecks[row - 1];
        EXPECT_THAT(line, testing::StartsWith("  " + check.name + " "));
        EXPECT_THAT(line, ContainsRegex("  (pass|draft|FAIL)$"));
      }
      EXPECT_EQ(row, 1 + kChecks.size());
    }
  }
}

TEST(CheckTable, LeavesOutWhatTellsLeast) {
  EXPECT_THAT(table(CheckColumn::used, 75),
              AllOf(HasSubstr("  RR_calf_joint"), HasSubstr("  worst"), HasSubstr("  limit")));
  EXPECT_THAT(table(CheckColumn::used, 60), AllOf(Not(HasSubstr("joint_")), Not(HasSubstr("where")),
                                                  HasSubstr("  worst"), HasSubstr(" 179 %  FAIL")));
  EXPECT_THAT(table(CheckColumn::used, 40),
              AllOf(Not(HasSubstr("worst")), Not(HasSubstr("limit")), HasSubstr(" 179 %  FAIL")));
  EXPECT_THAT(table(CheckColumn::time, 71), HasSubstr("  time"));
  EXPECT_THAT(table(CheckColumn::time, 70), AllOf(Not(HasSubstr("time")), HasSubstr("  RR_calf_joint")));
  EXPECT_THAT(table(CheckColumn::time, 64),
              AllOf(HasSubstr("  RR_calf  "), HasSubstr("  .._right_4"), HasSubstr("  limit")));
}

}  // namespace
}  // namespace prowl
