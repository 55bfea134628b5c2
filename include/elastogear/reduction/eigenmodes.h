#pragma once
// Undamped eigenmodes K phi = omega^2 M phi of a restrained body, lowest frequencies first.

#include <Eigen/Core>
#include <functional>
#include <string>

#include "elastogear/base/petsc.h"
#include "elastogear/base/progress.h"

namespace elastogear::reduction {

struct EigenOptions {
  int n_modes = 100;
  double tolerance = 1e-10;  ///< relative residual at which a mode counts as converged
  bool verify_count = true;  ///< count the eigenvalues below each window's end by the inertia of K - sigma M
  int window = 0;            ///< > 0: windows of at most so many modes; memory: about twice as many vectors
  int block = 16;            ///< right-hand sides that go through the factor together
  std::string prefix = {};   ///< of the options: -<prefix>eps_type, -<prefix>st_pc_type, ...
};

struct Eigenmodes {
  Eigen::VectorXd eigenvalue;  ///< n_modes, omega^2 in rad^2/s^2, ascending
  Eigen::VectorXd residual;    ///< n_modes, |K phi - omega^2 M phi| / |K phi|
  int iterations = 0;          ///< restarts of the eigensolver
};

/// Receives the modes one at a time, in ascending order, mass-normalised (phi' M phi = 1), sign arbitrary.
/// Called on all ranks.
using ModeSink = std::function<void(int index, Vec phi)>;

/// Throws Error naming both numbers unless 1 <= n_modes <= n_free.
void require_mode_count(int n_modes, int n_free);

/// SLEPc's Krylov-Schur with shift-and-invert about 0 and MUMPS' Cholesky for all modes at once, unless the
/// options database says otherwise; with options.window > 0 block Lanczos in windows up the spectrum
/// (reduction/windows.h). Reports the stage "eigenmodes". Collective. Throws Error when n_modes is not
/// in 1..n (n: size of K), when K is singular (the body is not held, or has a mechanism), when modes do not
/// converge or are missing.
Eigenmodes find_eigenmodes(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                           const Progress& progress = {});

/// Number of eigenvalues of (K, M) below sigma: the negative pivots of K - sigma M (Sylvester's law of
/// inertia).
int count_eigenvalues_below(Mat K, Mat M, double sigma);

/// The sign rule: the entry of largest modulus is positive. Of entries whose moduli agree to 1e-6 (symmetric
/// bodies) the first decides, so that roundoff, and with it the number of ranks, does not matter.
/// phi: all displacements in the mesh's order.
void fix_sign(Eigen::VectorXd& phi);

}  // namespace elastogear::reduction
