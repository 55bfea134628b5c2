#pragma once
// The surface of a mesh of another program, seen from the axis of its gear.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "elastogear/gear/toothing.h"
#include "elastogear/mesh/mesh.h"

namespace elastogear::gear {

/// A side of a cell at the surface.
struct ToothSide {
  std::vector<int> node;  ///< corners first
  int corners = 0;
  Eigen::Vector3d middle;  ///< m, of its corners
  Eigen::Vector3d n;       ///< outward unit normal there
  double area = 0;         ///< m^2, between its corners
};

/// outer: of mesh::outer_sides.
std::vector<ToothSide> tooth_sides(const mesh::Mesh& mesh, const std::vector<std::vector<int>>& outer);

inline double radius(const Eigen::Vector3d& x) { return x.head<2>().norm(); }

/// How much of a normal points around the axis, > 0 counter-clockwise.
double around_axis(const ToothSide& side);

/// m, between the ends of flanks.
inline double flank_height(const Toothing& t) { return std::abs(t.r_a - t.r_form); }

/// m, normal.
double normal_module(const Toothing& t);

/// Length in mm, for messages.
std::string in_mm(double length);

/// Throws Error unless all flanks of the gear have faces on most of their area; `covered`: m^2, by tooth, of
/// right and left ones.
void require_covered(const std::string& name, const Toothing& t, double width,
                     const std::vector<std::array<double, 2>>& covered);

}  // namespace elastogear::gear
