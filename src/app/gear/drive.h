#pragma once
// A drive file: several gears, their assembly and load. Every verb reads it and takes from it what it needs,
// so that meshes, bodies and places belong together.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/gear/facts.h"
#include "elastogear/gear/modification.h"
#include "elastogear/gear/size.h"
#include "elastogear/gear/toothing.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/mesh/read_report.h"

namespace elastogear::app {

/// How fine the meshes of a drive are.
struct MeshDensity {
  gear::Size size = gear::Size::tiny;
  int order = 2;          ///< of the hexahedra, 1 or 2
  double refinement = 1;  ///< of all counts of the size
};

/// One body of a drive.
struct DriveMember {
  std::string name;
  gear::Toothing toothing;
  /// The report is that of a mesh of one's own.
  std::function<mesh::Mesh(const MeshDensity&, mesh::ReadReport&)> mesh;
  bool is_worm = false;                                  ///< its stresses are those of a worm, not of a wheel
  std::string held;                                      ///< node set that carries the body frame
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< m, of the body frame's origin in the world
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();    ///< rad, rotation vector from body frame to world
  double angle = 0;                                      ///< rad, about the axis, then
  double ratio = 1;                                      ///< -, its speed over that of the first member
  double width = 0;                                      ///< m, of its teeth, symmetric about z = 0
  std::optional<gear::FlankDeviations> deviations = {};  ///< of its flanks; nothing: they are exact
};

struct DrivePair {
  int first = 0, second = 1;
  Facts facts;
};

struct Drive {
  std::vector<DriveMember> members;
  std::vector<Facts> facts;  ///< of each member
  std::vector<DrivePair> pairs;
};

}  // namespace elastogear::app
