#pragma once
// Tables of deviations: printed, or written as CSV.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace elastogear::app {

inline constexpr double kPercent = 100;  ///< of a share, in the tables

struct Table {
  std::string title;
  std::string heading;  ///< of the rows' names
  struct Column {
    std::string name, unit;  ///< unit "1": not printed
  };
  std::vector<Column> columns;
  std::vector<std::string> names;     ///< of the rows
  std::vector<Eigen::VectorXd> rows;  ///< one value a column; not finite: printed as -

  void add(const std::string& name, const Eigen::VectorXd& values);
};

void print(const Table& table);
/// Error when a name holds a comma, quote or line end.
void write_csv(const std::string& path, const Table& table);

}  // namespace elastogear::app
