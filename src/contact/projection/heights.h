#pragma once
// How far the surface that contact takes stands out of each facet: a polynomial height over the face, Eq.
// (6.19a). From the undeformed surface; heights stay what they are when it moves and deforms a little.

#include <Eigen/Core>
#include <vector>

#include "elastogear/contact/topology.h"
#include "elastogear/contact/true_surface.h"
#include "elastogear/contact/types.h"

namespace elastogear::contact {

inline constexpr int kHeightPoints = 7;  ///< along each side of a face; degree 6

/// m, of T_i T_j with Chebyshev polynomials T.
using HeightCoefficients = Eigen::Matrix<double, kHeightPoints, kHeightPoints>;

/// Heights over one face, Eq. (6.19a): polynomials of (u, v), stretched as Eq. (6.19b) says, on
/// quadrilaterals and of 2 (u, v) - 1 on triangles.
struct FaceHeights {
  HeightCoefficients C = HeightCoefficients::Zero();
  Stretch stretch = {};
};

/// Heights of one surface.
struct Heights {
  std::vector<FaceHeights> face = {};  ///< by face; none at all: facets as they are
  std::vector<Eigen::Matrix<double, 2, 4>> slope =
      {};  ///< by face: m, its derivatives with (u, v) at the corners

  bool empty() const { return face.empty(); }
};

/// Heights of `kind` with what is known of the true surface. Faces without exact heights take smooth ones;
/// deviations are added to any kind. feature_angle: rad, see corner_slopes. Throws Error when `known` does
/// not fit the surface.
Heights make_heights(const SurfaceView& undeformed, ContactSurface kind, double feature_angle,
                     const TrueSurface& known);

/// Height h(u, v) along the normal of face f, m. Beyond the sides it goes on as a parabola, less the fall
/// there.
FaceFunction height(const Heights& heights, int sides, int f, double u, double v);

/// Bound of |h| over all faces with their sides moved outwards by `extension` shares of the face's length, m.
double largest_height(const Heights& heights, double extension);

/// The largest curvature along u or v at 3 x 3 points of face f, 1/m.
double largest_curvature(const SurfaceView& undeformed, const Heights& heights, int f);

}  // namespace elastogear::contact
