#pragma once
// Finished harmonics of a cyclically symmetric body, kept on disk, so that a killed reduction goes on where
// it was.

#include <mpi.h>

#include <optional>
#include <string>

#include "elastogear/io/checkpoint_store.h"
#include "reduction/cyclic/harmonic_modes.h"

namespace elastogear::reduction {

/// One checkpoint per harmonic. The constructor and clear() are collective, the rest is not: each harmonic is
/// written by the one rank that found it.
class HarmonicCheckpoints {
 public:
  /// fingerprint: what the modes depend on, read on rank 0.
  HarmonicCheckpoints(MPI_Comm comm, const std::string& folder, const std::string& fingerprint);

  /// The harmonic when it is there with this cutoff.
  std::optional<HarmonicModes> read(int k, double cutoff) const;
  void write(const HarmonicModes& modes);
  /// Harmonics that were there at the start; checkpoints of another run that rank 0 removed.
  int n_known() const { return n_known_; }
  int discarded() const { return store_->discarded(); }
  void clear();

 private:
  MPI_Comm comm_;
  std::optional<io::CheckpointStore> store_;
  int n_known_ = 0;
};

}  // namespace elastogear::reduction
