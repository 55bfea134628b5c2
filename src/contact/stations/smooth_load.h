#pragma once
// Loads that are smooth to the mesh of a flank, around the places of stations, and what they do to an elastic
// half-space (docs/theory, section 6.18).

#include <Eigen/Core>
#include <array>
#include <vector>

#include "elastogear/contact/load_table.h"
#include "elastogear/contact/station_places.h"
#include "elastogear/contact/strip_kernel.h"

namespace elastogear::contact {

/// A side of a cell on a flank whose sides are in no rows and layers.
struct FlankPatch {
  std::vector<int> node;           ///< 3, 4, 6 or 8, corners first
  Eigen::Matrix<double, 2, 4> at;  ///< m, (v, z) of its corners; a triangle repeats its third one
};

/// Local coordinates of a place, and how far it lies beyond the corners, as a part of half their distance.
struct PlaceOnSide {
  int corners;
  Eigen::Vector2d at;
  double beyond;
};
PlaceOnSide place_on_side(const Eigen::Matrix<double, 2, 4>& corner, const Eigen::Vector2d& place);

/// The faces of a flank in rows along the profile and layers along the face, or patches. Places are (v, z),
/// m: the arc length of the profile, the same in all layers, and the face coordinate.
struct FlankGrid {
  using Face = std::array<int, 8>;  ///< corners around the face, then midside nodes from corner 0 - 1 on

  std::vector<double> v;        ///< limits of n_rows rows, ascending; with patches the ends of the flank
  std::vector<double> v_mid;    ///< of midside nodes within each row; empty: faces have 4 nodes
  std::vector<double> z;        ///< limits of n_layers layers, ascending; with patches the ends of the face
  std::vector<Face> face = {};  ///< row i n_layers + layer; corners at (v, z) low-low, high-low, high-high,
                                ///< low-high; nodes are numbers below n_nodes
  int n_nodes = 0;
  std::vector<FlankPatch> patch = {};  ///< in place of v_mid and face

  int n_rows() const { return static_cast<int>(v.size()) - 1; }
  int n_layers() const { return static_cast<int>(z.size()) - 1; }
};

/// 3/4 of the highest face, half of the longest one.
LoadWidth load_width(const FlankGrid& flank);

/// A force of 1 N over places across the profile: from < to, density (1 + tilt (x - middle)) / (to - from).
/// Eq. (6.43).
struct AcrossLoad {
  double from, to;  ///< m
  double tilt = 0;  ///< 1/m

  double middle() const { return (from + to) / 2; }
  double density(double x) const { return (1 + tilt * (x - middle())) / (to - from); }  ///< 1/m
  /// The same with places counted from x = 0 there, as far apart as `scale` times before.
  AcrossLoad seen_from(double x, double scale = 1) const {
    return {(from - x) * scale, (to - x) * scale, tilt / scale};
  }
};

/// Around the place v, which is its centroid, from `lower` to `upper` at most; its derivative with respect to
/// v is continuous. Places beyond an end count as
/// that end. Eq. (6.44).
AcrossLoad across_load(double v, double a, double lower, double upper);

/// One station of a pair of teeth, on the flank of one body.
struct StationPlace {
  Strip face;        ///< m, piece of the face, in z
  double v;          ///< m, arc length of the profile where the line of contact crosses its middle
  double slope = 0;  ///< -, dv/dz of the line of contact
};

/// n x n_nodes: consistent nodal forces of 1 N of each of n stations of a pair of teeth, along one direction.
/// Stations lie side by side in z where c > 0. Eq. (6.43).
Eigen::MatrixXd consistent_weights(const FlankGrid& flank, const std::vector<StationPlace>& stations,
                                   const LoadWidth& width);

/// The piece of the face over which the load of a point at z is spread: c to both sides, shifted inwards at
/// the ends of the face.
Strip point_strip(const FlankGrid& flank, double z, const LoadWidth& width);
/// n_nodes: consistent nodal forces of 1 N around a place, along a line of this slope. Eq. (6.43), even along
/// the face.
Eigen::RowVectorXd point_weights(const FlankGrid& flank, double v, double z, double slope,
                                 const LoadWidth& width);
/// 1/m: mean of 1/r within such a load, without images, which H. Hertz's ellipse has not, either. Eq. (6.46).
double point_kernel(const FlankGrid& flank, double v, double z, const LoadWidth& width,
                    const LineScale& scale);

/// n x n: the shares of each strip's load that lie on all of them, when it is spread over c to both sides and
/// reflected at the ends of the face that they fill. Rows sum to 1. Eq. (6.45).
Eigen::MatrixXd spread_along(const std::vector<Strip>& strips, double c);

/// 1/m: mean of 1/r between two loads across parallel lines, even along the strips. The places of both loads
/// are counted from the same line. Eq. (6.46).
double smooth_inverse_distance(const AcrossLoad& across_a, const Strip& a, const AcrossLoad& across_b,
                               const Strip& b);

/// n x n, 1/m: the same among all stations of a pair of teeth, spread along the face, with images at the ends
/// of the face, in z. Eq. (6.46).
Eigen::MatrixXd smooth_kernel(const FlankGrid& flank, const std::vector<StationPlace>& stations,
                              const LoadWidth& width, const FreeEnds& ends, const LineScale& scale);

}  // namespace elastogear::contact
