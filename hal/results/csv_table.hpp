// Comma-separated tables in memory: header row, numbers or words, '.' decimal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace st {

// The number that `text` is, in C notation, whatever the locale; false when it is none (also for nan and
// inf).
bool parse_number(std::string_view text, double& value);

// Views into the text that was parsed, which must outlive the table.
struct CsvTable {
  std::string name;
  std::vector<std::string_view> columns;
  std::vector<std::string_view> fields;  // row by row
  std::size_t rows() const { return columns.empty() ? 0 : fields.size() / columns.size(); }

  bool has(std::string_view column) const;
  std::size_t column(std::string_view column) const;  // Failure when it is missing
  std::string_view text(std::size_t row, std::size_t column) const {
    return fields[row * columns.size() + column];
  }
  // Failure when the field is not a number; `empty` for an empty field.
  double number(std::size_t row, std::size_t column, double empty = 0.0) const;
};

// Every row must have as many fields as the header. A last line without its end is left out: a killed
// run may leave one. Throws Failure (kBadInput) with name and line.
CsvTable parse_csv(std::string_view text, const std::string& name);

// The header and rows of numbers: stamp column first, then `decimals` for the others.
std::string format_csv(std::string_view header, std::size_t columns, const double* values, std::size_t rows,
                       int decimals);

}  // namespace st
