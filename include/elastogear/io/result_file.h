#pragma once
// The result file (HDF5, docs/file_format.md): written by simulate, read by recover, compare, info and
// scripts.

#include <memory>
#include <string>

#include "elastogear/model/result.h"

namespace elastogear::io {

/// Appends snapshots under a temporary name beside `path`; finish() renames it.
class ResultWriter {
 public:
  ResultWriter(const std::string& path, const model::ResultHeader& header);
  ~ResultWriter();
  void append(const model::Snapshot& snapshot);
  void finish();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Histories of one body, one column per output time.
struct BodyHistory {
  Eigen::MatrixXd q, q_dot, q_ddot;  ///< n_q x n_t
  Eigen::MatrixXd s, s_dot;          ///< n_s x n_t, joint coordinates
  Eigen::MatrixXd r_WB;              ///< 3 x n_t
  Eigen::MatrixXd R_WB;              ///< 9 x n_t, row-major rotation matrix
};

model::ResultHeader read_result_header(const std::string& path);
Eigen::VectorXd read_times(const std::string& path);
BodyHistory read_body_history(const std::string& path, const std::string& body);

}  // namespace elastogear::io
