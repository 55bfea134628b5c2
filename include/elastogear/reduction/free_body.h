#pragma once
// Bodies that nothing holds: rigid modes known from the coordinates, elastic modes orthogonal to them
// (docs/theory, section 2.4).

#include <slepcbv.h>

#include <Eigen/Core>

#include "elastogear/base/petsc.h"
#include "elastogear/fem/gather.h"
#include "elastogear/reduction/eigenmodes.h"

namespace elastogear::reduction {

using UniqueBV = Handle<BV, BVDestroy>;

struct RigidModes {
  UniqueBV R;        ///< six columns, orthonormal in the inner product of M
  double shift = 0;  ///< rad^2/s^2, > 0 and below the first elastic eigenvalue: K + shift M is definite
};

/// X: 3 x n_nodes, m, reference positions, on rank 0. The shift comes from the body's stiffness and mass for
/// fields quadratic in X, a Rayleigh-Ritz estimate of its first elastic eigenvalue. Collective. Throws Error
/// when K does not let the rigid fields move without force (coordinates that do not belong to K, a body that
/// is held).
RigidModes find_rigid_modes(Mat K, Mat M, const fem::VectorGather& gather, const Eigen::Matrix3Xd& X);

/// find_eigenmodes for a singular K: of K + shift M, whose modes are the same. Delivers n_modes elastic modes
/// orthogonal to the rigid ones to roundoff, the first elastic one with index 0. Throws Error unless exactly
/// six eigenvalues are zero (two parts that do not hang together have twelve).
Eigenmodes find_free_modes(Mat K, Mat M, const RigidModes& rigid, const EigenOptions& options,
                           const ModeSink& sink, const Progress& progress = {});

}  // namespace elastogear::reduction
