#pragma once
// Bodies whose contact is the point of a test, and equilibria of their systems.

#include "dynamics/run/snapshot.h"

namespace elastogear::test {

/// A rigid body with this surface as its one area of contact; inertia of a solid cube of size 1 m.
std::shared_ptr<model::ElasticBody> rigid_with(model::Surface surface, double mass = 1);

/// Fills in what an area of contact needs beside nodes and faces: node numbers, one face group.
void complete(model::Surface& surface);

/// A quarter (x, y >= 0) of an elastic half-space z <= 0 that is symmetric about x = 0 and y = 0, with a
/// surface of n^2 squares of size h in a corner. Normal displacements only: those of A. E. H. Love (Phil.
/// Trans. R. Soc. A 228 (1929) 377-420) for a pressure that is uniform on the square around each node.
struct HalfSpace {
  double E = 1, nu = 0;  ///< Pa, -
  double h = 1;          ///< m
  int n = 1;
};

/// Its surface bulges as the paraboloid z = -(x^2 + y^2) / 2R.
std::shared_ptr<const model::ElasticBody> half_space(const HalfSpace& spec, double R);

/// Where F(0, U, 0, 0) = 0, by Newton's method from U.
Eigen::VectorXd equilibrium(dynamics::System& system, Eigen::VectorXd U);
model::Snapshot state_at_rest(dynamics::System& system, const Eigen::VectorXd& U);

}  // namespace elastogear::test
