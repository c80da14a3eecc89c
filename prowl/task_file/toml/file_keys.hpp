#pragma once

#include <string>
#include <vector>

#include "prowl/task_file/toml/number_range.hpp"

namespace prowl {

/// One key of a robot or task file, declared once: the reader, options that replace a key, --help,
/// messages and the table in docs/ use it. The reader rejects other keys and numbers out of range.
/// Numeric defaults are those of the structs that the reader fills.
struct FileKey {
  std::string table = {};  ///< as in the file: "phase", "cost.contact_position"; "" at the top
  std::string name = {};
  std::string form = {};                  ///< "number", "3 numbers", "[min, max]", "[[surface]]"; "" if it has choices
  std::vector<std::string> choices = {};  ///< all allowed texts, if restricted
  NumberRange range = {};                 ///< of each number in the value
  std::string unit = {};                  ///< "m", "-" for a ratio, "" for none
  std::string fallback = {};              ///< default in words; "" if required, or without effect if absent
  std::string meaning = {};
  std::string formula = {};  ///< of what a term limits or weighs; "" if the meaning says it all

  std::string type() const;   ///< form or choices, and range: "number > 0"
  std::string value() const;  ///< type, unit and default: "number > 0 [m]; default 0.02"
};
using FileKeys = std::vector<FileKey>;

const FileKeys& robot_file_keys();
const FileKeys& task_file_keys();

/// The declared key of that name; it must exist.
const FileKey& file_key(const FileKeys& keys, const std::string& table, const std::string& name);
/// Names of the keys of one table, in order of declaration.
std::vector<std::string> key_names(const FileKeys& keys, const std::string& table);

}  // namespace prowl
