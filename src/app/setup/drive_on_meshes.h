#pragma once
// Bodies of a drive on coarser meshes, as `run` leaves them, for estimated errors by the mesh.

#include <string>
#include <vector>

#include "app/gear/drive_options.h"

namespace elastogear::app {

/// The drive with bodies on one mesh.
struct DriveOnMesh {
  double refinement = 1;
  Options options;
};

/// The folder of the drive's meshes but the last, each in one that has its refinement for a name.
std::string folder_of_meshes(const Options& options);

/// A drive and what it is on the coarser meshes there, the coarsest first.
struct DriveOnMeshes {
  double refinement = 1;  ///< of the drive's own bodies
  std::vector<DriveOnMesh> coarser = {};
  std::vector<std::string> left_out = {};  ///< what is there and does not serve, and why

  /// All of them, ascending.
  std::vector<double> refinements() const;
  /// Their body files.
  std::vector<std::string> bodies(const Drive& drive) const;
};

/// Left out are meshes of another input than that of the drive's own bodies, and all of them where these do
/// not say how fine they are or are not equally fine.
DriveOnMeshes drive_on_meshes(const Options& options, const Drive& drive);

}  // namespace elastogear::app
