#pragma once
// Nodes on the edges of a surface: at its boundary, and where it is sharp.

#include <array>
#include <vector>

#include "elastogear/contact/topology.h"

namespace elastogear::contact {

/// Marks the nodes on sides of the boundary.
std::vector<bool> boundary_nodes(const SurfaceView& surface);

/// Marks them and the nodes on convex edges that turn by more than the feature angle (rad).
std::vector<bool> edge_nodes(const SurfaceView& surface, double feature_angle);

/// Does a point of a face, with these weights of its corners, lie on a side of the boundary, or within a few
/// hundredths of the face beside it?
bool is_at_open_side(const SurfaceView& surface, int face, const Eigen::Vector4d& N);

/// The one face beyond a side of a face; -1 where there is none, or more than one.
int face_beyond(const Topology& topology, int face, int side);

/// Of the four faces that meet at a corner of a face, two of them beyond its sides there, the fourth; -1
/// where others than four meet.
int face_opposite(const SurfaceView& surface, int face, int corner, const std::array<int, 2>& beyond_sides);

}  // namespace elastogear::contact
