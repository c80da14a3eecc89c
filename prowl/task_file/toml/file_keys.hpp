#pragma once

#include <string>
#include <vector>

namespace prowl {

/// One key of a robot or task file. The reader takes no other, and docs/ lists exactly these (a test compares).
struct FileKey {
  std::string table;  ///< "" for the top, else as in the file: "phase", "cost.contact_position"
  std::string name;
  std::string value;  ///< type, unit, range, and the default where there is one
  std::string meaning;
};
using FileKeys = std::vector<FileKey>;

const FileKeys& robot_file_keys();
const FileKeys& task_file_keys();

/// Names of the keys of one table, in order of declaration.
std::vector<std::string> key_names(const FileKeys& keys, const std::string& table);
/// What the key means; for --help. The key must be declared.
const std::string& key_meaning(const FileKeys& keys, const std::string& table, const std::string& name);

}  // namespace prowl
