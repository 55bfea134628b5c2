#include "app/compare/compare_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "elastogear/base/text.h"
#include "elastogear/io/csv.h"

namespace elastogear::app {
namespace {

constexpr int kColumn = 11;  // characters

std::string title_of(const Table::Column& column) {
  return column.unit == "1" ? column.name : column.name + " " + column.unit;
}

int width_of(const Table::Column& column) {
  return std::max<int>(kColumn, static_cast<int>(title_of(column).size()) + 2);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return std::isfinite(value) ? text : "-";
}

}  // namespace

void Table::add(const std::string& name, const Eigen::VectorXd& values) {
  names.push_back(name);
  rows.push_back(values);
}

void print(const Table& table) {
  std::size_t first = table.heading.size();
  for (const std::string& name : table.names) first = std::max(first, name.size());
  const int indent = static_cast<int>(first);
  std::printf("\n%s\n%-*s", printable(table.title).c_str(), indent, table.heading.c_str());
  for (const auto& column : table.columns) std::printf("%*s", width_of(column), title_of(column).c_str());
  std::printf("\n");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    std::printf("%-*s", indent, printable(table.names[i]).c_str());
    for (std::size_t j = 0; j < table.columns.size(); ++j)
      std::printf("%*s", width_of(table.columns[j]),
                  number(table.rows[i][static_cast<Eigen::Index>(j)]).c_str());
    std::printf("\n");
  }
}

void write_csv(const std::string& path, const Table& table) {
  std::vector<io::CsvColumn> columns = {{table.heading, "1", {}, table.names}};
  for (std::size_t j = 0; j < table.columns.size(); ++j) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(table.rows.size()));
    for (std::size_t i = 0; i < table.rows.size(); ++i)
      values[static_cast<Eigen::Index>(i)] = table.rows[i][static_cast<Eigen::Index>(j)];
    columns.push_back({table.columns[j].name, table.columns[j].unit, values});
  }
  io::write_csv(path, columns);
}

}  // namespace elastogear::app
