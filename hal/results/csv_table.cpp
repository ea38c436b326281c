#include "hal/results/csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "hal/error.hpp"
#include "hal/results/text_format.hpp"

namespace st {
namespace {

// Cuts the next line off `text`, without its end ("\n" or "\r\n"). `whole`: it had an end.
std::string_view next_line(std::string_view& text, bool& whole) {
  const std::size_t end = text.find('\n');
  whole = end != std::string_view::npos;
  std::string_view line = text.substr(0, end);
  text.remove_prefix(whole ? end + 1 : text.size());
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

void split(std::string_view line, std::vector<std::string_view>& fields) {
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

bool parse_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

bool CsvTable::has(std::string_view wanted) const {
  return std::ranges::find(columns, wanted) != columns.end();
}

std::size_t CsvTable::column(std::string_view wanted) const {
  const auto found = std::ranges::find(columns, wanted);
  if (found == columns.end())
    throw Failure(ExitCode::kBadInput,
                  name + ": has no column '" + std::string(wanted) + "'; is it the right file?");
  return static_cast<std::size_t>(found - columns.begin());
}

double CsvTable::number(std::size_t row, std::size_t column, double empty) const {
  const std::string_view field = text(row, column);
  double value = empty;
  if (!field.empty() && !parse_number(field, value))
    throw Failure(ExitCode::kBadInput, name + ": row " + std::to_string(row + 1) + ", column " +
                                           std::string(columns[column]) + ": '" +
                                           std::string(field.substr(0, 20)) + "' is not a number");
  return value;
}

CsvTable parse_csv(std::string_view text, const std::string& name) {
  CsvTable table;
  table.name = name;
  bool whole = false;
  const std::string_view header = next_line(text, whole);
  if (header.empty()) throw Failure(ExitCode::kBadInput, name + ": is empty; a header row is expected");
  split(header, table.columns);
  for (std::size_t line_number = 2; !text.empty(); ++line_number) {
    const std::string_view line = next_line(text, whole);
    if (line.empty()) continue;
    const std::size_t before = table.fields.size();
    split(line, table.fields);
    if (table.fields.size() - before == table.columns.size() && whole) continue;
    table.fields.resize(before);
    if (!whole) break;
    throw Failure(ExitCode::kBadInput, name + ": line " + std::to_string(line_number) +
                                           " does not have the " + std::to_string(table.columns.size()) +
                                           " fields of the header");
  }
  return table;
}

std::string format_csv(std::string_view header, std::size_t columns, const double* values, std::size_t rows,
                       int decimals) {
  std::string out(header);
  out += '\n';
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      append_fixed(out, values[row * columns + column], column == 0 ? kStampDecimals : decimals);
      out += column + 1 < columns ? ',' : '\n';
    }
  return out;
}

}  // namespace st
