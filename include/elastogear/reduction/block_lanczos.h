#pragma once
// Block Lanczos with spectrum slicing as an EPS type of SLEPc (docs/theory, section 2.2).
//
// For K phi = lambda M phi with real symmetric K and positive definite M (EPS_GHEP). The problem is given by
// EPSSetOperators; everything else is SLEPc's usual EPS: EPSSolve, EPSGetEigenpair, EPSComputeError,
// -eps_view, -eps_monitor. It finds
//   EPS_SMALLEST_REAL (default)           the -eps_nev lowest eigenvalues
//   EPS_ALL, -eps_interval a,b            all eigenvalues between a and b, either of which may be infinite
//   EPS_TARGET_MAGNITUDE, _REAL           the -eps_nev next to -eps_target, which must lie below all of them
// each with a proof by inertia that none is missing. Eigenvectors are normalised to phi' M phi = 1. Options
// beside -eps_*, -st_*:
//   -eps_tol                              relative, of 1 / (lambda - shift) (default 1e-10)
//   -eps_ncv, -eps_mpd                    columns of the basis of a window, 200 at least (default: automatic)
//   -eps_block_lanczos_window             eigenpairs found at a time (default 0: automatic)
//   -eps_block_lanczos_block              columns that go through the factor together (default 0: automatic)
//   -eps_block_lanczos_count              whether to count by inertia (default true)
// ST is STSINVERT. Its default solver is the PC type "ldl", L D L' by MUMPS in the order of METIS, which
// forms no K - sigma M; a factorisation of PETSc that knows its inertia works as well (-st_pc_type cholesky
// takes MUMPS', which on several ranks needs -st_mat_mumps_icntl_13 1). The basis is of the BV type "slabs".

#include <slepceps.h>

#include <functional>

#include "elastogear/reduction/eigen_options.h"

namespace elastogear::reduction {

constexpr const char* kBlockLanczos = "block_lanczos";

/// Registers the EPS type "block_lanczos", the PC type "ldl" and the BV type "slabs". May be called more than
/// once.
void register_block_lanczos();

/// What SLEPc has no functions for. The options database wins over window, block and verify_count.
struct BlockLanczosSettings {
  int window = 0;                   ///< eigenpairs found at a time; 0: automatic
  int block = 0;                    ///< columns that go through the factor together; 0: automatic
  bool verify_count = true;         ///< compare the number of eigenvalues with the inertia of K - sigma M
  bool whole_pairs = false;         ///< find also what is as good as equal to the last of -eps_nev
  ShiftedSolver* factor = nullptr;  ///< of the PC type "ldl", borrowed; nullptr: by MUMPS
  double counted_below = 0;         ///< known to have -eps_nev eigenvalues below; 0: unknown
  SearchState start = {};           ///< of a search to be continued, in the same problem
};

/// Called on all ranks while EPSSolve runs. An exception ends it: see block_lanczos_check.
struct BlockLanczosHandler {
  /// Receives the eigenvectors of each finished window. When it is set the EPS keeps none of them:
  /// EPSGetEigenvector is an error.
  ModeSink mode = {};
  std::function<void(const SearchState&)> window = {};  ///< after the modes of a window: what start takes
  std::function<void(double fraction)> progress = {};
  std::function<void(double eigenvalue)> lowest =
      {};  ///< when the first eigenvalue is known, before its mode
};

/// Throw Error for another EPS type.
void block_lanczos_set(EPS eps, const BlockLanczosSettings& settings);
void block_lanczos_set_handler(EPS eps, BlockLanczosHandler handler);

/// All that the last EPSSolve found, that of `start` included.
const SearchState& block_lanczos_state(EPS eps);

/// check() for the code of EPSSolve, which rethrows what ended it. For any EPS type.
void block_lanczos_check(EPS eps, PetscErrorCode code);

}  // namespace elastogear::reduction
