#pragma once
// Items of an evaluation file, made from numbers, vectors and tables.

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "elastogear/io/evaluation_file.h"

namespace elastogear::evaluation {

/// A list of items that grows. What is not finite is not known and stays out.
class Items {
 public:
  void number(const std::string& path, const std::string& unit, const std::string& meaning, double value) {
    if (std::isfinite(value)) all_.push_back({path, unit, meaning, {}, {value}});
  }
  void curve(const std::string& path, const std::string& unit, const std::string& meaning,
             const Eigen::VectorXd& values) {
    if (values.size() > 0 && values.allFinite())
      all_.push_back({path, unit, meaning, {size(values.size())}, {values.begin(), values.end()}});
  }
  void table(const std::string& path, const std::string& unit, const std::string& meaning,
             const Eigen::MatrixXd& values) {
    if (values.size() == 0 || !values.allFinite()) return;
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = values;
    all_.push_back({path,
                    unit,
                    meaning,
                    {size(rows.rows()), size(rows.cols())},
                    {rows.data(), rows.data() + rows.size()}});
  }
  void words(const std::string& path, const std::string& meaning, const std::vector<std::string>& words) {
    if (!words.empty()) all_.push_back({path, "1", meaning, {words.size()}, {}, words});
  }
  void add(const std::vector<io::EvaluationItem>& items) {
    all_.insert(all_.end(), items.begin(), items.end());
  }
  std::vector<io::EvaluationItem>&& take() { return std::move(all_); }

 private:
  static std::size_t size(Eigen::Index n) { return static_cast<std::size_t>(n); }
  std::vector<io::EvaluationItem> all_;
};

}  // namespace elastogear::evaluation
