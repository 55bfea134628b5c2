#pragma once
// Figures of merit of a reduction: how good the basis of a body is (docs/theory, section 2.3).

#include <Eigen/Core>
#include <string>
#include <vector>

namespace elastogear::model {

/// One table, dataset `/checks/<name>` of the body file.
struct Check {
  std::string name;     ///< "static_completeness"
  std::string unit;     ///< "1" for none
  std::string meaning;  ///< one line
  Eigen::MatrixXd value;
  std::vector<std::string> row = {};  ///< names of the rows; empty: numbered
};

}  // namespace elastogear::model
