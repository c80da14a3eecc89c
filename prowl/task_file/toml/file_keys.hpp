#pragma once

#include <string>
#include <vector>

#include "prowl/task_file/toml/number_range.hpp"

namespace prowl {

/// One key of a robot or task file, declared once. The reader takes no other key and no number outside its range; the
/// options that replace a key, --help, messages and the table in docs/ come from here. Defaults that are numbers are
/// those of the structs that the reader fills.
struct FileKey {
  std::string table = {};  ///< "" for the top, else as in the file: "phase", "cost.contact_position"
  std::string name = {};
  std::string form = {};                  ///< "number", "3 numbers", "[min, max]", "[[surface]]"; "" if it has choices
  std::vector<std::string> choices = {};  ///< texts that it may be, if only these
  NumberRange range = {};                 ///< of each number in it
  std::string unit = {};                  ///< "m", "-" where it is a ratio, "" where there is none
  std::string fallback = {};              ///< its default, in words; "" if it is needed, or without effect where absent
  std::string meaning = {};

  std::string type() const;   ///< form or choices, and range: "number > 0"
  std::string value() const;  ///< type, unit and default: "number > 0 [m]; default 0.02"
};
using FileKeys = std::vector<FileKey>;

const FileKeys& robot_file_keys();
const FileKeys& task_file_keys();

/// The key of that name, which must be declared.
const FileKey& file_key(const FileKeys& keys, const std::string& table, const std::string& name);
/// Names of the keys of one table, in order of declaration.
std::vector<std::string> key_names(const FileKeys& keys, const std::string& table);

}  // namespace prowl
