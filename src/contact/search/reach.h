#pragma once
// How near to each other the points of two surfaces must be to be looked at.

#include <array>
#include <span>
#include <vector>

#include "contact/projection/heights.h"
#include "contact/search/tracker.h"

namespace elastogear::contact {

/// Of the faces of a surface.
struct FaceShapes {
  std::vector<double> diagonal;          ///< m, the longer one; of a triangle its longest side
  std::vector<double> curvature;         ///< 1/m, largest one
  std::vector<double> curvature_around;  ///< 1/m, largest one of the faces that a point held against this one
                                         ///< meets as it moves over one of its own faces
  double largest_curvature = 0;          ///< 1/m
};

struct Reach {
  Limits limits;
  double gap = 0;                    ///< m, of open candidates of the unilateral law
  double nearest = 0;                ///< m, how far outside the facets a point is that may be within it
  double rise = 0.125;               ///< of curvature times the square of a face's diagonal, see sag
  double most = 0.7072;              ///< of the diagonal, see sag
  std::array<FaceShapes, 2> shapes;  ///< of either surface; without faces where nodes alone are held
};

/// settings: complete. heights: over the faces of each surface, or of the smooth surface behind its facets.
Reach reach_of(const Settings& settings, const std::array<const Tracked*, 2>& tracked,
               const std::array<const Heights*, 2>& heights);

/// Bound of how far a gap within slave face f falls below that at the nearest corner (minima) or any corner
/// (faces), m: the rise of a sphere of the relative curvature over the face; never more than the farthest
/// point of the face is away. master_face: the nearest one; -1: any.
double sag(const Reach& reach, int slave_side, int f, int master_face);

/// The limits for a slave node, for whatever it may bound.
/// corners: of the slave's faces there, 4 face + corner.
Limits limits_at(const Reach& reach, int slave_side, std::span<const int> corners);

/// By how much less than limits.outside serves for each node of a slave, m; empty: none.
std::vector<double> spare(const Reach& reach, int slave_side, const Topology& topology);

/// The largest gap at such a node beside which one may lie within the reach, m.
double largest_gap_at(const Reach& reach, int slave_side, std::span<const int> corners, int master_face);

}  // namespace elastogear::contact
