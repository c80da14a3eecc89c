#pragma once

// Internal: strict TOML reading with actionable messages. Includes toml++: include it only in .cpp
// files.
#include <toml++/toml.h>

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/files/text_file.hpp"
#include "prowl/task_file/toml/file_keys.hpp"

namespace prowl {

/// Lower and upper bound of one quantity; equal where prescribed, infinite where free.
struct TomlBounds {
  double lower, upper;
};

/// Mistakes in a file, collected while reading goes on with allowed values.
class Mistakes {
 public:
  void add(int line, int column, const std::string& message);  ///< ignores duplicates
  bool empty() const { return found_.empty(); }
  /// True if the search stops: bounds the time for a file of 60,000 wrong keys.
  bool is_full() const { return count_ >= kMostCollected; }
  /// Throws all as one InputError, one line each, in file order; does nothing if there are none.
  void raise() const;

 private:
  static constexpr int kMostCollected = 100;
  std::map<std::pair<int, int>, std::vector<std::string>> found_;
  int count_ = 0;
};

/// One value of a TOML file, with its file, key path and key declaration (range). A wrong type,
/// number or name is a mistake "file:line:column: path: found; needed". If the document collects
/// mistakes, the reader returns an allowed number, vector or choice instead and goes on; otherwise,
/// or without a substitute, it throws InputError. Document and declaration must outlive the value.
class TomlValue {
 public:
  /// `key`: nullptr for a table with its own keys.
  TomlValue(const SourceText& source, const toml::node& node, std::string path, const FileKey* key,
            Mistakes* mistakes = nullptr)
      : source_(&source), node_(&node), path_(std::move(path)), key_(key), mistakes_(mistakes) {}

  double as_number() const { return as_number(key().range); }
  double as_number(const NumberRange& range) const;  ///< for a narrower range, or a value of several numbers
  int as_integer() const;
  bool as_boolean() const;
  std::string as_text() const;  ///< non-empty
  std::string as_name() const;  ///< text accepted by is_name() (text/name_check.hpp)
  std::vector<TomlValue> as_list() const;
  std::vector<TomlValue> as_list(std::size_t size) const;
  Eigen::Vector3d as_vector3() const;
  TomlBounds as_bounds() const;            ///< a number, "free" or [lower, upper]
  TomlBounds as_one_sided_bounds() const;  ///< the same; one end of [lower, upper] may be "free"
  TomlBounds as_range() const;             ///< a number or [min, max]
  /// One of the key's choices; `what` describes them in messages.
  const std::string& as_choice(const std::string& what) const { return key().choices[as_one_of(what, key().choices)]; }
  /// Index of the text in `known`; `what` describes these names in messages.
  std::size_t as_one_of(const std::string& what, const std::vector<std::string>& known) const;
  /// Entries of a table whose keys are among `known` (joints, contacts).
  std::vector<std::pair<std::string, TomlValue>> as_named_values(const std::vector<std::string>& known,
                                                                 const std::string& what) const;

  /// The same with any keys, for names that only the URDF defines.
  std::vector<std::pair<std::string, TomlValue>> as_free_named_values(const std::string& what) const;

  bool is_text() const { return node_->is_string(); }
  bool is_list() const { return node_->is_array(); }
  bool is_table() const { return node_->is_table(); }
  const toml::node& node() const { return *node_; }
  const SourceText& source() const { return *source_; }
  const std::string& path() const { return path_; }
  const FileKey& key() const;  ///< its declaration
  Mistakes* mistakes() const { return mistakes_; }

  /// Throws an inconsistency between values; not reported after a mistake, which may have caused
  /// it.
  [[noreturn]] void fail(const std::string& message) const;
  /// Collects a mistake and throws it: reading cannot go on.
  [[noreturn]] void fail_mistake(const std::string& message) const;
  [[noreturn]] void fail_unknown_name(const std::string& what, const std::vector<std::string>& known) const;

 private:
  [[noreturn]] void fail_type(const std::string& needed, const std::string& hint = "") const;
  /// Collects a mistake; throws it unless mistakes are collected.
  void refuse(const std::string& message) const;
  void refuse_type(const std::string& needed, const std::string& hint = "") const;
  std::string located(const std::string& message) const;
  std::string not_allowed(const std::string& needed, const std::string& hint) const;

  const SourceText* source_;
  const toml::node* node_;
  std::string path_;
  const FileKey* key_;
  Mistakes* mistakes_;
};

/// A table with exactly the keys that file_keys.hpp declares for it.
class TomlTable {
 public:
  /// `declared`: table name in `keys` ("phase" for phase[1]). An undeclared key is a mistake.
  TomlTable(const TomlValue& value, const FileKeys& keys, const std::string& declared);

  std::optional<TomlValue> find(const std::string& key) const;
  TomlValue need(const std::string& key) const;  ///< throws InputError if missing
  const TomlValue& value() const { return value_; }

  std::optional<TomlTable> find_table(const std::string& key) const;
  /// The tables of [[key]]; none if absent.
  std::vector<TomlTable> find_tables(const std::string& key, std::size_t most = kMostTables) const;
  static constexpr std::size_t kMostTables = 1000;  ///< per [[key]]; checks between them are quadratic

 private:
  const toml::table& table() const { return *value_.node().as_table(); }
  /// Value of an unknown key that is `key`, misspelt; if any.
  std::optional<TomlValue> find_misspelt(const std::string& key) const;
  bool has_unknown_key() const;
  std::string path_of(const std::string& key) const;

  TomlValue value_;
  const FileKeys* keys_;
  std::string declared_;
};

/// A parsed file. Throws InputError with the parser's message and the location of a syntax error or
/// duplicate key.
class TomlDocument {
 public:
  explicit TomlDocument(const SourceText& source);
  TomlDocument(const TomlDocument&) = delete;  // values point into it
  TomlDocument& operator=(const TomlDocument&) = delete;
  TomlTable root(const FileKeys& keys) const;
  /// Returns read(), which reads this document; throws all its mistakes as one InputError.
  template <class Read>
  auto read_with(const Read& read) const {
    try {
      auto result = read();
      mistakes_.raise();
      return result;
    } catch (const InputError&) {
      mistakes_.raise();
      throw;
    }
  }
  /// Reports undeclared keys in the whole file, including parts that reading may not reach.
  void check_all_keys(const FileKeys& keys) const;
  /// Adds a mistake in another file, or one without a location.
  void add_mistake(const std::string& message) const;

  /// Throws `message` at a top-level key that indicates another kind of file.
  void refuse_key(const std::string& key, const std::string& message) const;

 private:
  SourceText source_;
  toml::table table_;
  mutable Mistakes mistakes_;
};

/// "file:line:column: " of a key path ("contact[1].frame") in a valid file, or of its deepest
/// existing part; "file:1:1: " if none exists. For errors of other layers.
std::string locate(const SourceText& source, const std::string& path);
/// The same for the key itself, if its name is wrong.
std::string locate_key(const SourceText& source, const std::string& path);
/// locate(); nullopt if no part of the path exists.
std::optional<std::string> find_location(const SourceText& source, const std::string& path);

}  // namespace prowl
