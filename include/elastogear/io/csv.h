#pragma once
// Tables as comma-separated values.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace elastogear::io {

struct CsvColumn {
  std::string name;  ///< without comma, quote or line end
  std::string unit;  ///< "1" for none
  Eigen::VectorXd values;
  std::vector<std::string> words = {};  ///< in place of values, as the names
};

/// One header row "time [s],force [N],..." and one row per entry; numbers read back exactly. Error when
/// columns differ in length.
void write_csv(const std::string& path, const std::vector<CsvColumn>& columns);

}  // namespace elastogear::io
