#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "prowl/files/text_file.hpp"

namespace prowl {

/// Parts of a text between separators; one more than there are separators.
std::vector<std::string_view> split_text(std::string_view text, char separator);

/// The numbers in one line of a CSV file, also "nan" and "inf". Throws InputError that begins with `where` unless there
/// is one number per column.
std::vector<double> csv_numbers(const std::string& where, std::string_view line,
                                const std::vector<std::string>& columns);

/// A CSV file of numbers under a heading.
struct CsvTable {
  std::vector<std::string> columns;
  Eigen::MatrixXd values;  ///< one column per row of the file, so each row is contiguous
  std::string file;        ///< for messages

  Eigen::Index rows() const { return values.cols(); }
  /// Index of a column; throws InputError if there is none of this name.
  Eigen::Index index(const std::string& column) const;
};

/// Largest file with a table [bytes]: two minutes of a quadruped's simulation at 1 kHz.
constexpr std::size_t kLongestTable = std::size_t{384} << 20;

/// Throws InputError "file:line: ..." unless every line has one number per name in the heading, and a line end.
CsvTable read_csv_table(const SourceText& source);

}  // namespace prowl
