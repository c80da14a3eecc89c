#include "prowl/io/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "prowl/error.hpp"
#include "prowl/model/nearest_name.hpp"

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

std::vector<double> csv_numbers(const std::string& where, std::string_view line, const std::vector<std::string>& columns) {
  const std::vector<std::string_view> cells = split_text(line, ',');
  if (cells.size() != columns.size()) {
    throw InputError(fmt::format("{}: {} cells; need {}", where, cells.size(), columns.size()));
  }
  std::vector<double> row(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto [end, error] = std::from_chars(cells[i].data(), cells[i].data() + cells[i].size(), row[i]);
    if (error != std::errc{} || end != cells[i].data() + cells[i].size()) {
      throw InputError(fmt::format("{}: {}: \"{}\" is not allowed; need a finite number", where, columns[i], cells[i]));
    }
  }
  return row;
}

Eigen::Index CsvTable::index(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end()) {
    throw InputError(fmt::format("{}:1: no column {}{}", file, column, did_you_mean(column, columns)));
  }
  return found - columns.begin();
}

CsvTable read_csv_table(const SourceText& source) {
  CsvTable table;
  table.file = source.path.string();
  std::vector<std::string_view> lines = split_text(source.text, '\n');
  if (!lines.back().empty() || lines.size() < 2) {
    throw InputError(fmt::format("{}: the last line has no end; the file is cut short", table.file));
  }
  lines.pop_back();
  for (const std::string_view name : split_text(lines[0], ',')) table.columns.emplace_back(name);
  table.values.resize(static_cast<Eigen::Index>(table.columns.size()), static_cast<Eigen::Index>(lines.size() - 1));
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<double> row = csv_numbers(fmt::format("{}:{}", table.file, i + 1), lines[i], table.columns);
    std::copy(row.begin(), row.end(), table.values.col(static_cast<Eigen::Index>(i - 1)).data());
  }
  return table;
}

}  // namespace prowl
