#pragma once
// The true surface of a body behind its facets, as far as it is known: heights of an exact surface and
// measured or designed deviations (docs/theory.md, section 6.8).

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "elastogear/model/elastic_body.h"

namespace elastogear::contact {

/// Heights stand along the normal of the undeformed face, in the BRF.
struct TrueSurface {
  /// By face: m, at the height_points of the face; empty where no exact surface is known. No entries:
  /// nowhere.
  std::vector<Eigen::VectorXd> height = {};
  /// n_s, m, of each node along the outward normal of the surface, linear between nodes; > 0: material added.
  /// Empty: none.
  Eigen::VectorXd deviation = {};
};

/// Local coordinates (contact/face.h) at which heights over a face with 4 or 3 sides are known: the tensor
/// product of Chebyshev-Lobatto points, or the lattice of a triangle. Corners are among them.
const std::vector<Eigen::Vector2d>& height_points(int sides);

/// Heights of face f at its height_points, m. distance: m, from a point of the face along its unit normal n
/// to the exact surface.
Eigen::VectorXd sampled_heights(
    const model::Surface& surface, int f,
    const std::function<double(const Eigen::Vector3d& x, const Eigen::Vector3d& n)>& distance);

/// m, the most by which the polynomial through the heights of face f misses the surface halfway between its
/// points: 0 but for roundoff on flanks without creases.
double height_error(
    const model::Surface& surface, int f, const Eigen::VectorXd& heights,
    const std::function<double(const Eigen::Vector3d& x, const Eigen::Vector3d& n)>& distance);

}  // namespace elastogear::contact
