#pragma once
// Modes on their way from the eigensolver to the body file: each finished window is a checkpoint on disk, so
// that a killed reduction goes on where it was.

#include <mpi.h>

#include <functional>
#include <optional>

#include "elastogear/io/body_file.h"
#include "elastogear/io/checkpoint_store.h"
#include "elastogear/reduction/eigenmodes.h"

namespace elastogear::reduction {

/// One mode as it is stored.
struct ModeRecord {
  Eigen::VectorXd column;  ///< mode_column, see reduction/basis.h
  Eigen::VectorXd phi;     ///< 3 n_nodes; empty unless stored in full
};

/// All members but `add` and `visit` are collective; those two belong to rank 0.
class ModeCheckpoints {
 public:
  /// fingerprint: what the modes depend on, read on rank 0.
  ModeCheckpoints(MPI_Comm comm, const std::string& folder, const std::string& fingerprint,
                  io::Precision precision);

  /// State of the search after the last whole checkpoint; the start of a new search when there is none.
  SearchState resume(int n_own) const;
  /// Number of checkpoints of other options or another mesh that were removed, on rank 0.
  int discarded() const { return store_ ? store_->discarded() : 0; }
  void add(int index, const ModeRecord& mode);
  void commit(const SearchState& state);
  /// Every mode once or, the last time valid, again; one in memory at a time.
  void visit(const std::function<void(int index, const ModeRecord&)>& f) const;
  void clear();

 private:
  MPI_Comm comm_;
  int rank_ = 0;
  io::Precision precision_;
  std::optional<io::CheckpointStore> store_;     // rank 0
  std::optional<io::CheckpointWriter> current_;  // rank 0
  int first_ = 0;                                // mode of the current checkpoint
};

}  // namespace elastogear::reduction
