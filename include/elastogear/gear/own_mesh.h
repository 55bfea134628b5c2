#pragma once
// Meshes of cylindrical gears that other programs have made, beside the data of the gear.

#include <string>

#include "elastogear/gear/toothing.h"
#include "elastogear/mesh/mesh.h"

namespace elastogear::gear {

/// The data of a gear whose mesh is its user's.
struct OwnGear {
  std::string name;  ///< in errors
  Toothing toothing;
  double width = 0;        ///< m, of its teeth
  std::string held;        ///< node set that carries the body frame; empty: the user names others
  double held_radius = 0;  ///< m, of the cylinder where it is, where the mesh has no set of its name
};

/// How a mesh came to lie in the body frame.
struct MeshFit {
  double turn = 0;      ///< rad, about z
  double shift = 0;     ///< m, along z
  double farthest = 0;  ///< m, from a corner of a face to its exact flank
};

/// Places a mesh whose axis is z: moves it along z until the middle of its teeth is at z = 0, and turns it by
/// half a pitch at most until its flanks lie on those of the toothing. Nodes of flanks are put onto them.
/// Finds its face sets left, right, flanks, `tooth_<ii>_left`, `tooth_<ii>_right`, its node sets root and
/// `root_<ii>` (nodes of the surface between the flanks), and the held one where it has none. Throws Error
/// for flanks that are not those of the toothing: it names the node that is farthest off, its place and what
/// is allowed.
MeshFit fit_own_mesh(mesh::Mesh& mesh, const OwnGear& gear);

}  // namespace elastogear::gear
