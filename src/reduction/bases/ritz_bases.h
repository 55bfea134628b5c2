#pragma once
// Bases of a held body beside its eigenmodes, to compare with (docs/theory, section 2.7).

#include <Eigen/Core>
#include <vector>

#include "elastogear/base/progress.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/ritz_options.h"
#include "reduction/bases/ritz.h"

namespace elastogear::reduction {

/// Most static solutions for unit forces that are kept together. So many vectors, and dense matrices of so
/// many rows, are affordable.
inline constexpr int kMostInterface = 3000;

struct RitzTask {
  Mat K, M;
  RitzOptions options;
  EigenOptions eigen;               ///< n_modes: eigenmodes of modal_attachment, vectors of the others
  std::vector<int> interface_rows;  ///< ascending: displacements of the interface; not of krylov
  Eigen::MatrixXd loads;            ///< own rows, N: of krylov only
};

/// Throws Error that names the count and `sets` when there are more than kMostInterface rows, or none.
void require_affordable(const std::vector<int>& interface_rows, const std::vector<std::string>& sets);

/// modal_attachment: n_modes eigenmodes and the static solutions for unit forces on the interface.
/// craig_bampton: the lowest vectors of the pencil that is condensed to the interface, and modes of the body
/// that is held there, together n_modes.
/// krylov: K_s^-1 B, K_s^-1 M K_s^-1 B, ... for the loads B and K_s = K - (2 pi shift)^2 M, n_modes at most:
/// fewer when these spaces end.
/// products: of the task's K and M; must outlive the space. Collective. Throws Error for counts that do not
/// fit, naming the option, for a singular K, and what find_eigenmodes throws.
RitzSpace find_space(const RitzTask& task, const BlockProduct& K, const BlockProduct& M,
                     const Progress& progress = {});

}  // namespace elastogear::reduction
