#pragma once
// Eigenmodes of one harmonic of a cyclically symmetric body (docs/theory, section 2.6).

#include <Eigen/Core>

#include "elastogear/fem/sector_assembly.h"
#include "elastogear/reduction/eigenmodes.h"

namespace elastogear::reduction {

/// The modes of harmonic k below a limit. Unless the harmonic is real, each column z stands for two modes of
/// the body with one eigenvalue, those of z and of i z.
struct HarmonicModes {
  int k = 0;
  double cutoff = 0;           ///< rad^2/s^2: these are all modes below it
  int iterations = 0;          ///< of the eigensolver
  Eigen::VectorXd eigenvalue;  ///< rad^2/s^2, of each column, ascending
  Eigen::VectorXd residual;    ///< |K_k z - lambda M_k z| / |K_k z|
  double orthogonality = 0;    ///< largest |z_i^H M_k z_j|, i != j
  Eigen::MatrixXd z;           ///< coordinates x columns, z' M_k z = 1; on rank 0 of the communicator
};

/// The lowest options.n_modes eigenvectors of the harmonic by block Lanczos with spectrum slicing of
/// options.window. Of a harmonic that is not real they are whole pairs, and of each pair one is returned. The
/// phase rule: the component of largest modulus is real and positive; of components equal to 1e-6 the first
/// decides. Collective. Leaves k's cutoff at 0. first_orbit: the first of this rank (fem::own_orbits).
HarmonicModes find_harmonic_modes(const fem::Matrices& matrices, const fem::Harmonic& harmonic,
                                  int first_orbit, const EigenOptions& options,
                                  const Progress& progress = {});

/// Columns z by the phase rule, or of a real harmonic by that of signs.
void fix_phases(const fem::Harmonic& harmonic, Eigen::MatrixXd& z);

}  // namespace elastogear::reduction
