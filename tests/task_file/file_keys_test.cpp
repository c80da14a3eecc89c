#include "prowl/task_file/toml/file_keys.hpp"

#include <gmock/gmock.h>

#include <set>
#include <sstream>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

using Names = std::multiset<std::pair<std::string, std::string>>;  // table and key

/// What a section of docs/reference.md lists: rows "| `key` | ..." below "### `table`" or "### Top level".
Names listed(const std::string& page, const std::string& section) {
  std::istringstream lines(page.substr(page.find("\n## " + section + "\n") + 1));
  Names names;
  std::string line, table;
  std::getline(lines, line);
  while (std::getline(lines, line) && !line.starts_with("## ")) {
    const std::size_t open = line.find('`'), close = line.find('`', open + 1);
    if (line.starts_with("### ")) table = open == std::string::npos ? "" : line.substr(open + 1, close - open - 1);
    if (line.starts_with("| `")) names.emplace(table, line.substr(open + 1, close - open - 1));
  }
  return names;
}

Names declared(const FileKeys& keys) {
  Names names;
  for (const FileKey& key : keys) names.emplace(key.table, key.name);
  return names;
}

// On a failure, run scripts/reference.
TEST(FileKeys, DocumentationListsExactlyTheDeclaredKeys) {
  const std::string page = test::read_file(std::filesystem::path(PROWL_SOURCE_DIR) / "docs/reference.md");
  EXPECT_EQ(listed(page, "Task file"), declared(task_file_keys()));
  EXPECT_EQ(listed(page, "Robot file"), declared(robot_file_keys()));
  EXPECT_GT(listed(page, "Robot file").size(), 10u);
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
