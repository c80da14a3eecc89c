#include "prowl/files/csv_table.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

TEST(CsvTable, ReadsNumbersByTheNamesOfTheirColumns) {
  const CsvTable table = read_csv_table({"a.csv", "time_s,x\n0,1e-3\n0.5,nan\n"});
  ASSERT_EQ(table.rows(), 2);
  EXPECT_EQ(table.values(table.index("time_s"), 1), 0.5);
  EXPECT_EQ(table.values(table.index("x"), 0), 1e-3);
  EXPECT_TRUE(std::isnan(table.values(table.index("x"), 1)));
}

TEST(CsvTable, SaysWhereItIsWrong) {
  const auto message = [](const std::string& text) {
    return test::message_of("", [&] { read_csv_table({"a.csv", text}); });
  };
  EXPECT_THAT(message("t,x\n0,1\n0\n"), HasSubstr("a.csv:3: 1 cells; need 2"));
  EXPECT_THAT(message("t,x\n0,1m\n"), HasSubstr("a.csv:2: x: \"1m\""));
  EXPECT_THAT(message(std::string(2000000, ',') + "\n"), HasSubstr("a.csv:1: 2000001 columns; need at most 100000"));
  EXPECT_THAT(message(std::string(50000, ',') + "\n" + std::string(50000, '\n')),
              HasSubstr("too short for 50001 columns and 50000 rows"))
      << "20 GB";
  EXPECT_THAT(message("t,x\n0,\x1b[2J\n"), HasSubstr("a.csv:2: x: \"\\x1b[2J\" is not allowed"));
  EXPECT_THAT(message("t,x\n0,1"), HasSubstr("cut short"));
  EXPECT_THAT(message(""), HasSubstr("cut short"));
  EXPECT_THAT(test::message_of("", [] { read_csv_table({"a.csv", "time_s,x\n"}).index("times"); }),
              HasSubstr("no column times; did you mean 'time_s'"));
}

}  // namespace
}  // namespace prowl
