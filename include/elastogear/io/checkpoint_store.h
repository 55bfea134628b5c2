#pragma once
// Results of a long run, kept checkpoint by checkpoint in a folder of their own, so that a killed run can be
// continued.

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "elastogear/io/precision.h"

namespace elastogear::io {

/// The checkpoints in a folder: one HDF5 file each, which appears under its name only when complete.
class CheckpointStore {
 public:
  /// Checkpoints of another fingerprint (all that the results depend on, as text) and incomplete ones are
  /// removed. The folder need not exist; it is made with the first checkpoint.
  CheckpointStore(std::string folder, std::string fingerprint);

  /// Names of the checkpoints at the start and of those added, ascending.
  const std::vector<std::string>& names() const { return names_; }
  /// Number of checkpoints of another fingerprint that were removed.
  int discarded() const { return discarded_; }
  void add(const std::string& name);
  std::string path(const std::string& name) const;
  const std::string& folder() const { return folder_; }
  const std::string& fingerprint() const { return fingerprint_; }
  /// Deletes the checkpoints, and the folder unless it holds other files.
  void clear();

 private:
  std::string folder_, fingerprint_;
  std::vector<std::string> names_;
  int discarded_ = 0;
};

/// Writes one checkpoint. Destroyed before commit(): nothing stays.
class CheckpointWriter {
 public:
  CheckpointWriter(CheckpointStore& store, const std::string& name);
  ~CheckpointWriter();
  void write(const std::string& array, const Eigen::MatrixXd& values);
  /// Adds a row to the array of this name, which grows on disk. All rows are of one length.
  void append(const std::string& array, const Eigen::VectorXd& row, Precision precision = Precision::float64);
  /// Adds the checkpoint to the store.
  void commit();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Reads one checkpoint. Error naming file and array when one is missing or damaged.
class CheckpointReader {
 public:
  CheckpointReader(const CheckpointStore& store, const std::string& name);
  ~CheckpointReader();
  bool has(const std::string& array) const;
  Eigen::MatrixXd read(const std::string& array) const;
  int n_rows(const std::string& array) const;
  Eigen::VectorXd read_row(const std::string& array, int row) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace elastogear::io
