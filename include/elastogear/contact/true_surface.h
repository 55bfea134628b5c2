#pragma once
// The true surface of a body behind its facets, as far as it is known: heights of an exact surface and
// measured or designed deviations (docs/theory, section 6.8).

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "elastogear/contact/exact_flanks.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::contact {

/// A coordinate of a quadrilateral along which heights are no smooth function, but one of t, Eq. (6.19b).
struct Stretch {
  int along = 0;      ///< 0: u, 1: v
  double amount = 0;  ///< between -1 and 1; > 0: finest at the side -1, < 0: at the side 1
  double bulge = 0;   ///< 0 to 1, by which the line that the heights begin at there bends into the face
  double fall = 0;    ///< m, of heights in half a face beyond that line, Eq. (6.19d); 0: they go on
};

/// Heights of an exact surface over one face.
struct ExactHeights {
  Eigen::VectorXd value = {};  ///< m, at the height_points of the face; empty: no exact surface is known
  Stretch stretch = {};        ///< of quadrilaterals: the height_points are values of t
};

/// Heights stand along the normal of the undeformed face, in the BRF.
struct TrueSurface {
  std::vector<ExactHeights> height = {};  ///< by face; no entries: nowhere
  /// n_s, m, of each node along the outward normal of the surface, linear between nodes; > 0: material added.
  /// Empty: none.
  Eigen::VectorXd deviation = {};
  std::shared_ptr<const ExactFlanks> flanks = {};  ///< null: they have no charts
};

/// Local coordinates (contact/face.h) at which heights over a face with 4 or 3 sides are known where it is
/// not stretched: the tensor product of Chebyshev-Lobatto points, or the lattice of a triangle. Corners are
/// among them.
const std::vector<Eigen::Vector2d>& height_points(int sides);

/// Heights of face f at its height_points, m. distance: m, from a point of the face along its unit normal n
/// to the exact surface.
ExactHeights sampled_heights(
    const model::Surface& surface, int f,
    const std::function<double(const Eigen::Vector3d& x, const Eigen::Vector3d& n)>& distance,
    const Stretch& stretch = {});

/// m, the most by which the polynomial through the heights of face f misses the surface halfway between its
/// points: 0 but for roundoff on flanks without creases.
double height_error(
    const model::Surface& surface, int f, const ExactHeights& heights,
    const std::function<double(const Eigen::Vector3d& x, const Eigen::Vector3d& n)>& distance);

}  // namespace elastogear::contact
