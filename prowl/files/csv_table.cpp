#include "prowl/files/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "prowl/error.hpp"
#include "prowl/text/nearest_name.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl {

std::vector<std::string_view> split_text(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::vector<double> csv_numbers(const std::string& where, std::string_view line,
                                const std::vector<std::string>& columns) {
  const std::size_t size = 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
  if (size != columns.size()) throw InputError(fmt::format("{}: {} cells; need {}", where, size, columns.size()));
  const std::vector<std::string_view> cells = split_text(line, ',');
  std::vector<double> row(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto [end, error] = std::from_chars(cells[i].data(), cells[i].data() + cells[i].size(), row[i]);
    if (error != std::errc{} || end != cells[i].data() + cells[i].size()) {
      throw InputError(
          fmt::format("{}: {}: \"{}\" is not allowed; need a finite number", where, columns[i], shown(cells[i])));
    }
  }
  return row;
}

Eigen::Index CsvTable::index(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end()) {
    throw InputError(fmt::format("{}:1: no column {}{}", file, column, shown(did_you_mean(column, columns))));
  }
  return found - columns.begin();
}

CsvTable read_csv_table(const SourceText& source) {
  CsvTable table;
  table.file = source.path.string();
  std::string_view text = source.text;
  if (!text.ends_with('\n'))
    throw InputError(fmt::format("{}: the last line has no line end; the file is cut short", table.file));
  const auto next_line = [&text] {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(line.size() + 1);
    return line;
  };
  const auto rows = std::count(text.begin(), text.end(), '\n') - 1;
  const std::string_view names = next_line();
  const auto columns = std::count(names.begin(), names.end(), ',') + 1;
  // Checked before the allocation: each cell has a character and a separator.
  constexpr std::ptrdiff_t kMostColumns = 100000, kFewCells = 1000000;
  if (columns > kMostColumns)
    throw InputError(fmt::format("{}:1: {} columns; need at most {}", table.file, columns, kMostColumns));
  if (rows > 0 && columns > (kFewCells + std::ssize(text) / 2) / rows) {
    throw InputError(fmt::format("{}: too short for {} columns and {} rows", table.file, columns, rows));
  }
  for (const std::string_view name : split_text(names, ',')) table.columns.emplace_back(name);
  table.values.resize(columns, rows);
  for (std::ptrdiff_t i = 0; i < rows; ++i) {
    const std::vector<double> row = csv_numbers(fmt::format("{}:{}", table.file, i + 2), next_line(), table.columns);
    std::copy(row.begin(), row.end(), table.values.col(i).data());
  }
  return table;
}

}  // namespace prowl
