#pragma once

// Internal to io: reading TOML strictly, with messages that a user can act on. Includes toml++: keep to .cpp files.
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
struct Bounds {
  double lower, upper;
};

/// What is wrong with a file, collected while it is read on with values that are allowed.
class Mistakes {
 public:
  void add(int line, int column, const std::string& message);  ///< once, if it is added twice
  bool empty() const { return found_.empty(); }
  /// Whether there are so many that no more are looked for: a file of 60,000 wrong keys takes no time.
  bool is_full() const { return count_ >= kMostCollected; }
  /// All as one InputError, a line each, from the top of the file to its end; nothing if there are none.
  void raise() const;

 private:
  static constexpr int kMostCollected = 100;
  std::map<std::pair<int, int>, std::vector<std::string>> found_;
  int count_ = 0;
};

/// One value of a TOML file that knows its file, the path of its key and the declaration of the key, whose range its
/// numbers keep. A wrong type, number or name is a mistake "file:line:column: path: what it is; what is needed". Of a
/// document that collects them a number, a vector or a choice is then one that is allowed, so that the rest can be
/// read; else, and where there is nothing to go on with, it is thrown as InputError. The document and the declaration
/// must outlive it.
class TomlValue {
 public:
  /// `key` is nullptr of a table with keys of its own.
  TomlValue(const SourceText& source, const toml::node& node, std::string path, const FileKey* key,
            Mistakes* mistakes = nullptr)
      : source_(&source), node_(&node), path_(std::move(path)), key_(key), mistakes_(mistakes) {}

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
  Mistakes* mistakes() const { return mistakes_; }

  /// Throws what is wrong between values: after a mistake it may follow from that, and is left out.
  [[noreturn]] void fail(const std::string& message) const;
  /// Collects a mistake of its own and throws it: there is nothing to go on with.
  [[noreturn]] void fail_mistake(const std::string& message) const;
  [[noreturn]] void fail_unknown_name(const std::string& what, const std::vector<std::string>& known) const;

 private:
  [[noreturn]] void fail_type(const std::string& needed, const std::string& hint = "") const;
  /// Collects a mistake, or throws it if nobody does.
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
  /// `declared` names the table among `keys` ("phase" for phase[1]). A key that is not declared is a mistake.
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
  /// The value of the key that was misspelt, if that was this one.
  std::optional<TomlValue> find_misspelt(const std::string& key) const;
  bool has_unknown_key() const;
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
  /// What `read` returns, which reads this document: if that finds mistakes, all of them are thrown as one InputError.
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
  /// Looks for keys that are not declared in the whole file, also where reading may not come to.
  void check_all_keys(const FileKeys& keys) const;
  /// A mistake in another file that this one names, or one without a location.
  void add_mistake(const std::string& message) const;

  /// Throws `message` at the key if the top has it: the sign of another kind of file.
  void refuse_key(const std::string& key, const std::string& message) const;

 private:
  SourceText source_;
  toml::table table_;
  mutable Mistakes mistakes_;
};

/// "file:line:column: " of a key path ("contact[1].frame") in a file that parses, or of the deepest part of the path
/// that it has; "file:1:1: " if it has none. For what other layers find wrong.
std::string locate(const SourceText& source, const std::string& path);
/// The same of the key, where not its value but its name is wrong.
std::string locate_key(const SourceText& source, const std::string& path);
/// locate(); none if the file has no part of the path.
std::optional<std::string> find_place(const SourceText& source, const std::string& path);

}  // namespace prowl
