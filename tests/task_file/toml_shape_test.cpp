#include "prowl/task_file/toml/toml_shape.hpp"

#include <gmock/gmock.h>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using test::repeated;

std::string message(const std::string& text) {
  return test::message_of([&] { check_toml_shape({"a.toml", text}); });
}

TEST(TomlShape, TakesWhatIsFlat) {
  const std::string many = repeated("0.25, ", 1000);
  EXPECT_EQ(message("x = [" + many + "]\ny = [" + many + "]\n"), "") << "the points of numbers are of no key";
  EXPECT_EQ(message("a.b.c = 1\n[d.e.f]\ng = {h = {i = [[1.5, 2.5]]}}\n"), "");
  EXPECT_EQ(message("x = " + repeated("[", kDeepestToml) + repeated("]", kDeepestToml)), "");
  EXPECT_EQ(message("a" + repeated(".a", kDeepestToml - 1) + " = 1"), "");
}

TEST(TomlShape, RefusesDepth) {
  EXPECT_EQ(message("\nx = " + repeated("[", 17)), "a.toml:2:21: brackets more than 16 deep are not allowed");
  EXPECT_THAT(message("x = " + repeated("{a=[", 17)), testing::HasSubstr("brackets more than 16"));
  EXPECT_EQ(message("a" + repeated(".a", 16) + " = 1"), "a.toml:1:32: dotted keys more than 16 deep are not allowed");
  EXPECT_THAT(message("[a" + repeated(" . \"a\"", 16) + "]"), testing::HasSubstr("dotted keys more than 16"));
  EXPECT_THAT(message("x = {a" + repeated(".'a'", 16) + " = 1}"), testing::HasSubstr("dotted keys"));
}

/// Brackets and dots in these are text, and what comes behind them is looked at again.
TEST(TomlShape, KnowsStringsAndComments) {
  const std::string deep = repeated("[", 50) + repeated(".a", 50);
  const std::string texts[] = {"\"" + deep + "\"",
                               "'" + deep + "'",
                               "\"\\\"" + deep + "\"",
                               "'" + deep + "\\'",
                               "\"\"\"" + deep + "\"\"\"",
                               "'''\n" + deep + "'''",
                               "\"\"\"\\\"\"\" " + deep + "\"\"\"",
                               "\"\"\"" + deep + "\"\"\"\"\"",
                               "'''it''s " + deep + "''''",
                               "1 # it's " + deep,
                               "\"\" # \" " + deep,
                               "'' # '" + deep};
  for (const std::string& text : texts) {
    EXPECT_EQ(message("x = " + text + "\n"), "") << text;
    EXPECT_THAT(message("x = " + text + "\ny = " + deep), testing::HasSubstr("brackets more than 16")) << text;
  }
}

}  // namespace
}  // namespace prowl
