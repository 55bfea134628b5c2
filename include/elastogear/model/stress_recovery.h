#pragma once
// How the stresses at nodes are recovered from displacements (docs/theory, sections 1.1 and 1.5).

#include <vector>

namespace elastogear::model {

/// average: the mean of what the elements at a node extrapolate to it. surface: on surfaces without forces
/// from the strains of the surface and the traction that is zero there, elsewhere the mean.
enum class RecoveryMethod { average, surface };

struct StressRecovery {
  RecoveryMethod method = RecoveryMethod::average;
  std::vector<int> loaded = {};  ///< nodes on which forces may act, mesh numbers, ascending
};

}  // namespace elastogear::model
