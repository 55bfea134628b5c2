#pragma once
// Wishes, present state and result of a search for eigenmodes.

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "elastogear/base/petsc.h"
#include "elastogear/reduction/interval.h"

namespace elastogear::reduction {

constexpr int kAutomaticWindow = -1;

class ShiftedSolver;

/// State of a search between two windows: all that the next one depends on.
struct SearchState {
  double lower = -std::numeric_limits<double>::infinity();  ///< rad^2/s^2, a gap above the modes found
  double shift = lower;        ///< of the last window; the modes under it are proved complete
  int below_shift = 0;         ///< eigenvalues under it
  Eigen::VectorXd eigenvalue;  ///< of the modes found, ascending
  Eigen::VectorXd residual;    ///< theirs
  Eigen::MatrixXd edge;        ///< own rows of the last of them, for the check against the next window
  double orthogonality = 0;    ///< see Eigenmodes
  int iterations = 0;
};

struct EigenOptions {
  int n_modes = 100;
  double tolerance = 1e-10;  ///< relative residual at which a mode counts as converged
  bool verify_count = true;  ///< compare the number of modes with the inertia of K - sigma M
  /// All modes in it, in place of the n_modes lowest.
  std::optional<Interval> interval = {};
  /// > 0: block Lanczos in intervals of about so many modes; kAutomaticWindow; 0: Krylov-Schur, all
  /// at once.
  int window = 0;
  int block = 0;             ///< right-hand sides that go through the factor together; 0: automatic
  double counted_below = 0;  ///< rad^2/s^2, known to have n_modes eigenvalues below (windows); 0: unknown
  bool whole_pairs = false;  ///< deliver also the modes above n_modes that are as good as equal to the last
  /// Factor of K - sigma M that block Lanczos uses, borrowed; nullptr: by MUMPS. Not with -st_pc_type.
  ShiftedSolver* factor = nullptr;
  std::string prefix = {};  ///< of the options: `-<prefix>eps_type`, `-<prefix>st_pc_type`, ...
  SearchState start = {};   ///< of a search to be continued, in windows
  std::function<void(const SearchState&)> commit = {};  ///< called when a window's modes are delivered
};

struct Eigenmodes {
  Eigen::VectorXd eigenvalue;  ///< omega^2 in rad^2/s^2, ascending; n_modes, or more by whole_pairs
  Eigen::VectorXd residual;    ///< |K phi - omega^2 M phi| / |K phi| of each mode
  double orthogonality = 0;    ///< largest |phi_i' M phi_j|, i != j, within windows and across their ends
  int iterations = 0;          ///< restarts of the eigensolver, or blocks
};

/// Receives the modes one at a time, in ascending order, mass-normalised (phi' M phi = 1), sign arbitrary.
/// Called on all ranks. Should a later window find that an earlier one missed a mode, the modes from there on
/// come again under their right numbers; what was received before under these is void.
using ModeSink = std::function<void(int index, Vec phi)>;

}  // namespace elastogear::reduction
