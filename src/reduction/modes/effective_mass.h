#pragma once
// Effective modal mass: how much of the body's inertia its modes carry (docs/theory.md, section 2.3).

#include <Eigen/Core>

#include "elastogear/base/petsc.h"
#include "elastogear/fem/gather.h"
#include "elastogear/fem/inertia.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::reduction {

/// Three translations x y z (kg), three rotations about axes x y z through the centre of mass (kg m^2).
using SixDirections = Eigen::Matrix<double, 6, 1>;

/// Row k: the effective masses of mode k, the squares of its couplings. n_q x 6.
Eigen::Matrix<double, Eigen::Dynamic, 6> effective_masses(const model::Inertia& inertia);

/// The body's own: m, m, m and the diagonal of J about the centre of mass.
SixDirections body_masses(const model::Inertia& inertia);

/// Sum of the effective masses of all modes, S' M_:f M_ff^-1 M_f: S, Eq. (2.6). It is less than the body's
/// own because restrained nodes carry mass. M: over the free displacements. Collective; moments and c are
/// read on rank 0, where the result is.
SixDirections mobile_masses(Mat M, const fem::VectorGather& gather, const fem::MassMoments& moments,
                            const Eigen::Vector3d& c);

}  // namespace elastogear::reduction
