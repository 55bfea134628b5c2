#pragma once
// Eigenmodes of several harmonics at once from the sector cut open (docs/theory, section 2.6, Eq.
// (2.11b)).

#include <optional>
#include <vector>

#include "elastogear/base/progress.h"
#include "reduction/cyclic/condensed_sector.h"
#include "reduction/cyclic/harmonic_modes.h"

namespace elastogear::reduction {

struct HarmonicTask {
  const fem::Harmonic* harmonic;
  int n_modes;  ///< amplitudes z: as many as there are below the cutoff
};

struct BelowCutoff {
  double cutoff = 0;  ///< rad^2/s^2
  double tolerance = 1e-10;
  int block = 0;  ///< vectors of a harmonic that go through the factor at a time; 0: automatic
};

/// All modes below the cutoff by complex block Lanczos about one shift, harmonic by harmonic; the blocks of
/// all go through the sector's factor together. None for a harmonic whose basis has no more room before that.
/// Memory: for each harmonic the factor of its border, and 1.7 n_modes + 24 block vectors. Throws Error when
/// the body is not held.
std::vector<std::optional<HarmonicModes>> find_modes_together(CondensedSector& sector,
                                                              const std::vector<HarmonicTask>& tasks,
                                                              const BelowCutoff& wanted,
                                                              const Progress& progress = {});

}  // namespace elastogear::reduction
