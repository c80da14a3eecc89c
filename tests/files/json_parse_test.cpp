#include "prowl/files/json_parse.hpp"

#include <gmock/gmock.h>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using test::repeated;
using testing::HasSubstr;

std::string message(const std::string& text) {
  return test::message_of([&] { parse_json({"a.json", text}); });
}

std::string keys(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += (i == 0 ? "\"k" : ",\"k") + std::to_string(i) + "\":1";
  return text;
}

TEST(JsonParse, ReadsWhatIsThere) {
  EXPECT_EQ(parse_json({"a.json", R"({"b": [1, {"c": null}], "a": "x"})"}).dump(), R"({"b":[1,{"c":null}],"a":"x"})");
}

TEST(JsonParse, SaysWhereItIsNoJson) {
  EXPECT_THAT(message("{\n  \"a\": 1,\n"), HasSubstr("a.json:3:"));
  EXPECT_THAT(message("{\"a\": NaN}"), HasSubstr("a.json:1:"));
  EXPECT_THAT(message(""), HasSubstr("a.json:1:1: not JSON"));
}

TEST(JsonParse, RefusesDepth) {
  EXPECT_EQ(message(repeated("[", kDeepestJson) + repeated("]", kDeepestJson)), "");
  EXPECT_EQ(message(repeated("{\"a\":", kDeepestJson) + "1" + repeated("}", kDeepestJson)), "");
  EXPECT_THAT(message(repeated("[", kDeepestJson + 2) + repeated("]", kDeepestJson + 2)), HasSubstr("deep"));
  EXPECT_THAT(message(repeated("[", 1000000)), HasSubstr("deep"));
  EXPECT_THAT(message(repeated("{\"a\":", 1000000)), HasSubstr("deep"));
}

TEST(JsonParse, RefusesTooManyKeysOfOneObject) {
  EXPECT_EQ(message("[{" + keys(kMostJsonKeys) + "}, {" + keys(kMostJsonKeys) + "}]"), "") << "each has its own";
  EXPECT_THAT(message("{" + keys(kMostJsonKeys + 1) + "}"), HasSubstr("keys more than 200"));
  EXPECT_THAT(message("{\"x\": {" + keys(100) + "}, " + keys(kMostJsonKeys) + "}"), HasSubstr("keys more than 200"))
      << "those around it count on";
}

TEST(JsonParse, RefusesTooManyValues) {
  EXPECT_THAT(message("[" + repeated("0,", kMostJsonValues) + "0]"), HasSubstr("values more than"));
}

TEST(JsonParse, RefusesNumbersBeyondDoubles) { EXPECT_THAT(message("[1e999]"), HasSubstr("1.8e308")); }

}  // namespace
}  // namespace prowl
