#include "prowl/task_file/toml/file_keys.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

/// The list as the pages have it.
std::string markdown_table(const FileKeys& keys) {
  std::string text = "| table | key | value | meaning |\n|---|---|---|---|\n";
  for (const FileKey& key : keys) {
    const std::string table = key.table.empty() ? "(top)" : fmt::format("`{}`", key.table);
    text += fmt::format("| {} | `{}` | {} | {} |\n", table, key.name, key.value(), key.meaning);
  }
  return text;
}

// On a failure, copy the table from the message into the page.
TEST(FileKeys, DocumentationListsExactlyTheDeclaredKeys) {
  const std::filesystem::path docs = std::filesystem::path(PROWL_SOURCE_DIR) / "docs";
  EXPECT_THAT(test::read_file(docs / "task-file.md"), HasSubstr(markdown_table(task_file_keys())));
  EXPECT_THAT(test::read_file(docs / "robot-file.md"), HasSubstr(markdown_table(robot_file_keys())));
}

// So that the example is one that is planned by the tests, and passes.
TEST(FileKeys, DocumentationShowsAShippedTask) {
  const std::filesystem::path source = PROWL_SOURCE_DIR;
  const std::string task = test::read_file(source / "tasks/hyq/crouch.toml");
  ASSERT_GT(task.size(), 500u);
  EXPECT_THAT(test::read_file(source / "docs/task-file.md"), HasSubstr("```toml\n" + task + "```\n"));
}

TEST(FileKeys, AreDeclaredOnce) {
  for (const FileKeys& keys : {task_file_keys(), robot_file_keys()}) {
    std::set<std::pair<std::string, std::string>> seen;
    for (const FileKey& key : keys)
      EXPECT_TRUE(seen.emplace(key.table, key.name).second) << key.table << "." << key.name;
    EXPECT_GT(seen.size(), 10u);
  }
}

}  // namespace
}  // namespace prowl
