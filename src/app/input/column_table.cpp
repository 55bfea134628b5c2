#include "app/input/column_table.h"

#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include "app/options/units.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"

namespace elastogear::app {
ColumnTable::ColumnTable(const std::string& file)
    : in_(open_input(file)), reader_(in_, file, io::DelimitedReader::Separator::one) {}

bool ColumnTable::next() {
  while (reader_.next("#")) {
    const bool first = !std::exchange(started_, true);
    const std::string_view field = reader_.fields()[0];
    const bool word =
        !field.empty() && (std::isalpha(static_cast<unsigned char>(field[0])) || field[0] == '"');
    if (!first || !word || parse<double>(field)) return true;
    for (const std::string_view heading : reader_.fields()) {
      if (!heading.empty() && std::string_view("[(/").find(heading[0]) != std::string_view::npos)
        fail_here("'", heading, "' is no heading of a column: names with units are apart by commas");
      units_.push_back(heading_of(reader_.place(), std::string(heading)).unit);
    }
  }
  return false;
}

double ColumnTable::number(std::size_t column, const std::string& unit) const {
  const std::string field = text(column), of_column = column < units_.size() ? units_[column] : "";
  if (of_column.empty() && field.find(' ') == field.npos) return reader_.number(column);
  if (unit == "-")
    fail_here("'", field, of_column.empty() ? "" : " " + of_column, "' must be a number without a unit");
  const bool own = field.find(' ') != field.npos;
  try {
    const std::optional<double> value =
        parse<double>(in_unit("number", field + (own ? "" : " " + of_column), unit));
    if (value && std::isfinite(*value)) return *value;
  } catch (const Error& error) {
    fail_here(error.what());
  }
  fail_here("'", field, "' must be a finite number");
}

}  // namespace elastogear::app
