#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "prowl/files/text_file.hpp"

namespace prowl {

/// Parts of a text between separators; one more than there are separators.
std::vector<std::string_view> split_text(std::string_view text, char separator);

/// The numbers in one line of a CSV file, "nan" and "inf" too. Throws InputError, beginning with `where`, unless there
/// is one for each of the columns.
std::vector<double> csv_numbers(const std::string& where, std::string_view line,
                                const std::vector<std::string>& columns);

/// A CSV file of numbers under a heading.
struct CsvTable {
  std::vector<std::string> columns;
  Eigen::MatrixXd values;  ///< a row of the file is a column: a line at a time lies together
  std::string file;        ///< for messages

  Eigen::Index rows() const { return values.cols(); }
  /// Place of a column; throws InputError if there is none of this name.
  Eigen::Index index(const std::string& column) const;
};

/// Most bytes of a file with a table: two minutes of a quadruped's simulation at 1 kHz.
constexpr std::size_t kLongestTable = std::size_t{384} << 20;

/// Throws InputError "file:line: ..." unless all lines have as many numbers as the heading has names, and the last one
/// ends.
CsvTable read_csv_table(const SourceText& source);

}  // namespace prowl
