#pragma once
// Effective modal mass: how much of the body's inertia its modes carry (docs/theory, section 2.3).

#include <Eigen/Core>
#include <functional>

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

/// M S at all nodes (3 n_nodes, kg or kg m) of a rigid motion; rotations are about c.
Eigen::VectorXd rigid_momentum(const fem::MassMoments& moments, const Eigen::Vector3d& c, int direction);

/// p' M^-1 p for six vectors p, which set(direction, p) sets. Collective.
SixDirections inverse_masses(Mat M, const std::function<void(int direction, Vec p)>& set);

/// Sum of the effective masses of all modes, S' M_:f M_ff^-1 M_f: S, Eq. (2.6). It is less than the body's
/// own because restrained nodes carry mass. M: over the free displacements. Collective; moments and c are
/// read on rank 0, where the result is.
SixDirections mobile_masses(Mat M, const fem::VectorGather& gather, const fem::MassMoments& moments,
                            const Eigen::Vector3d& c);

}  // namespace elastogear::reduction
