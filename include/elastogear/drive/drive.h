#pragma once
// A drive: gears with their meshes, their places in the world, and the pairs that are in mesh. The world's
// frame is that of the first gear of a cylindrical drive; worms lie along its x axis, their wheels about z.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/gear/cylindrical.h"
#include "elastogear/gear/design.h"
#include "elastogear/gear/modification.h"
#include "elastogear/gear/size.h"
#include "elastogear/gear/toothing.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/mesh/read_report.h"

namespace elastogear::drive {

/// How fine the meshes of a drive are.
struct MeshDensity {
  gear::Size size = gear::Size::tiny;
  int order = 2;          ///< of the hexahedra, 1 or 2
  double refinement = 1;  ///< of the counts of the size, see gear::refined
};

/// One gear.
struct Member {
  std::string name;
  gear::Toothing toothing;
  /// The report is that of a mesh file of the user's own.
  std::function<mesh::Mesh(const MeshDensity&, mesh::ReadReport&)> mesh;
  bool is_worm = false;                                  ///< its stresses are those of a worm, not of a wheel
  std::string held;                                      ///< node set that carries the body frame
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< m, of the body frame's origin in the world
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();    ///< rad, rotation vector from body frame to world
  double angle = 0;                                      ///< rad, about the axis, then
  double ratio = 1;                                      ///< -, its speed over that of the first member
  double width = 0;                                      ///< m, of its teeth, symmetric about z = 0
  std::optional<gear::FlankDeviations> deviations = {};  ///< of its flanks; nothing: they are exact
  bool misaligned = false;                               ///< by misalign()
};

/// Two members in mesh.
struct Pair {
  int first = 0, second = 1;
};

struct Drive {
  std::vector<Member> members;  ///< the driving one first
  std::vector<Pair> pairs;
  /// Of meshes of size tiny, ascending, that leave all their counts near the cells whole. Ratios of at least
  /// 1.3 tell changes by the mesh from scatter (ASME V&V 20).
  std::vector<double> refinements = {1, 1.5, 2, 3, 4, 6};
};

/// "pinion:wheel".
std::string pair_name(const Drive& drive, const Pair& pair);

/// Where a drive begins.
struct Start {
  double roll = 0;      ///< pitches by which the first gear is turned from where a tooth points to its mate
  bool coasts = false;  ///< are flanks in touch that drive the first gear, not those that it drives with?
};

/// Gears in place, with their flanks of that side in touch. geometry: of the design, by derive().
Drive cylindrical_drive(const gear::CylindricalDrive& design, const gear::CylindricalGeometry& geometry,
                        const Start& start);
/// A worm and its wheel.
Drive worm_drive(const gear::Design& design, const gear::Geometry& geometry, const Start& start);

/// How far a gear is from its place. Directions are those of its axis, of the common perpendicular away from
/// its mate's axis, and of the first x the second.
struct Misalignment {
  double radial = 0, tangential = 0, axial = 0;  ///< m: away from the mate, along the third, along the axis
  double inclination = 0;  ///< rad, in the plane of both axes; > 0: the axis' +z end leans away from the mate
  double skew = 0;         ///< rad, out of that plane; > 0: its +z end leans along the third direction
};

/// Moves the gears. misalignment: of each member.
void misalign(Drive& drive, const std::vector<Misalignment>& misalignment);

}  // namespace elastogear::drive
