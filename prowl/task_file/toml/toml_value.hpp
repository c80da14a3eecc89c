#pragma once

// Internal to io: reading TOML strictly, with messages that a user can act on. Includes toml++: keep to .cpp files.
#include <toml++/toml.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "prowl/files/text_file.hpp"
#include "prowl/task_file/toml/file_keys.hpp"

namespace prowl {

/// Lower and upper bound of one quantity; equal where prescribed, infinite where free.
struct Bounds {
  double lower, upper;
};

/// One value of a TOML file that knows its file, the path of its key and the declaration of the key, whose range its
/// numbers keep. Every as_... throws InputError "file:line:column: path: what it is; what is needed". The document and
/// the declaration must outlive it.
class TomlValue {
 public:
  TomlValue(const SourceText& source, const toml::node& node, std::string path, const FileKey* key)
      : source_(&source), node_(&node), path_(std::move(path)), key_(key) {}

  double as_number() const { return as_number(key().range); }
  double as_number(const NumberRange& range) const;  ///< for what is narrower than the key, or not one number
  int as_integer() const;
  std::string as_text() const;  ///< not empty
  std::string as_name() const;  ///< a text that is_name (model/name_check.hpp) accepts
  std::vector<TomlValue> as_list() const;
  std::vector<TomlValue> as_list(std::size_t size) const;
  Eigen::Vector3d as_vector3() const;
  Bounds as_bounds() const;  ///< a number, "free" or [lower, upper]
  Bounds as_range() const;   ///< a number or [min, max]
  /// One of the choices of the key, which are names of a `what`.
  const std::string& as_choice(const std::string& what) const { return key().choices[as_one_of(what, key().choices)]; }
  /// Index of a text in `known`, which are names of a `what`.
  std::size_t as_one_of(const std::string& what, const std::vector<std::string>& known) const;
  /// The entries of a table with names that the user chooses from `known` (joints, contacts).
  std::vector<std::pair<std::string, TomlValue>> as_named_values(const std::vector<std::string>& known,
                                                                 const std::string& what) const;

  /// The same where the reader does not know the names yet: the URDF has them.
  std::vector<std::pair<std::string, TomlValue>> as_free_named_values(const std::string& what) const;

  bool is_text() const { return node_->is_string(); }
  bool is_list() const { return node_->is_array(); }
  bool is_table() const { return node_->is_table(); }
  const toml::node& node() const { return *node_; }
  const SourceText& source() const { return *source_; }
  const std::string& path() const { return path_; }
  const FileKey& key() const;  ///< its declaration

  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void fail_unknown_name(const std::string& what, const std::vector<std::string>& known) const;

 private:
  [[noreturn]] void fail_type(const std::string& needed, const std::string& hint = "") const;

  const SourceText* source_;
  const toml::node* node_;
  std::string path_;
  const FileKey* key_;  ///< nullptr: a table with keys of its own
};

/// A table with exactly the keys that file_keys.hpp declares for it.
class TomlTable {
 public:
  /// `declared` names the table among `keys` ("phase" for phase[1]). Throws InputError on a key that is not declared.
  TomlTable(const TomlValue& value, const FileKeys& keys, const std::string& declared);

  std::optional<TomlValue> find(const std::string& key) const;
  TomlValue need(const std::string& key) const;  ///< throws InputError if missing
  const TomlValue& value() const { return value_; }

  std::optional<TomlTable> find_table(const std::string& key) const;
  /// The tables of [[key]]; none if absent.
  std::vector<TomlTable> find_tables(const std::string& key, std::size_t most = kMostTables) const;
  static constexpr std::size_t kMostTables = 1000;  ///< of one [[key]]; checks among them are quadratic

 private:
  const toml::table& table() const { return *value_.node().as_table(); }
  std::string path_of(const std::string& key) const;

  TomlValue value_;
  const FileKeys* keys_;
  std::string declared_;
};

/// A parsed file. Throws InputError with the parser's words and the place of a syntax error or a duplicate key.
class TomlDocument {
 public:
  explicit TomlDocument(const SourceText& source);
  TomlDocument(const TomlDocument&) = delete;  // values point into it
  TomlDocument& operator=(const TomlDocument&) = delete;
  TomlTable root(const FileKeys& keys) const;
  /// Throws `message` at the key if the top has it: the sign of another kind of file.
  void refuse_key(const std::string& key, const std::string& message) const;

 private:
  SourceText source_;
  toml::table table_;
};

/// "file:line:column: " of a key path ("contact[1].frame") in a file that parses, or of the deepest part of the path
/// that it has; "file:1:1: " if it has none. For what other layers find wrong.
std::string locate(const SourceText& source, const std::string& path);
/// The same of the key, where not its value but its name is wrong.
std::string locate_key(const SourceText& source, const std::string& path);
/// locate(); none if the file has no part of the path.
std::optional<std::string> find_place(const SourceText& source, const std::string& path);

}  // namespace prowl
