#pragma once
// Undamped eigenmodes K phi = omega^2 M phi of a restrained body, lowest frequencies first.

#include <Eigen/Core>
#include <string>

#include "elastogear/base/progress.h"
#include "elastogear/reduction/eigen_options.h"

namespace elastogear::reduction {

/// Throws Error naming both numbers unless 1 <= n_modes <= n_free.
void require_mode_count(int n_modes, int n_free);

/// By SLEPc's EPS, of the type "block_lanczos" (elastogear/reduction/block_lanczos.h) or, with options.window
/// = 0, "krylovschur" with shift-and-invert about 0 and MUMPS' Cholesky for all modes at once, unless the
/// options database says otherwise (`-<prefix>eps_type`, `-<prefix>eps_tol`, `-<prefix>st_*`, ...); it does
/// not choose the number of modes. Of a small body of which a large part of the spectrum is wanted, by LAPACK
/// unless asks_slepc. Reports the stage "eigenmodes". Collective. Throws Error when n_modes is not
/// in 1..n (n: size of K) or no mode lies in the interval, when K is singular (the body is not held, or has a
/// mechanism), when modes do not converge or are missing. docs/theory, Eq. (2.3).
Eigenmodes find_eigenmodes(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                           const Progress& progress = {});

/// Whether the options database has options of the eigensolver or its spectral transformation with this
/// prefix
/// (`-<prefix>eps_*`, `-<prefix>st_*`), but for those that say which modes: `eps_nev`, `eps_interval`. Only
/// EPSSolve obeys all of them.
bool asks_slepc(const std::string& prefix);

/// Number of eigenvalues of (K, M) below sigma: the negative pivots of K - sigma M (Sylvester's law of
/// inertia).
int count_eigenvalues_below(Mat K, Mat M, double sigma);

/// The sign rule: the entry of largest modulus is positive. Of entries whose moduli agree to 1e-6
/// (symmetric bodies) the first decides, so that roundoff, and with it the number of ranks, does not matter.
/// phi: all displacements in the mesh's order.
void fix_sign(Eigen::VectorXd& phi);

}  // namespace elastogear::reduction
