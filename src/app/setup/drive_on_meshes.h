#pragma once
// Bodies of a drive on coarser meshes, as `run` leaves them, for estimated errors by the mesh.

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

  /// All of them, ascending.
  std::vector<double> refinements() const;
};

/// Meshes of another input are left out; so are all where the bodies do not say how fine they are.
DriveOnMeshes drive_on_meshes(const Options& options, const Drive& drive);

}  // namespace elastogear::app
