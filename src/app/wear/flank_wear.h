#pragma once
// What the flanks of one gear lose in a sweep, by Archard's law in their own coordinates.

#include <optional>
#include <string>
#include <vector>

#include "app/gear/drive.h"
#include "app/wear/wear_options.h"
#include "elastogear/gear/flank.h"
#include "elastogear/life/wear.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::app {

/// One gear of the drive: its flanks, all teeth alike.
struct WearingGear {
  const DriveMember* member = nullptr;
  WearMaterial material;
  model::Surface surface = {};                         ///< of its body file
  std::vector<std::optional<gear::Flank>> flank = {};  ///< of each node of the surface
  Eigen::VectorXd layers = {};                         ///< m, z of the corners of cells across the face
  life::FlankCells cells = {};                         ///< u: length of roll, v: z
  Eigen::MatrixXd depth[2] = {};                       ///< cells, m, of left and right flanks
};

/// Error when the body has no involute flanks.
WearingGear wearing_gear(const DriveMember& member, const WearMaterial& material,
                         const WearSettings& settings, model::Surface surface);

/// Worn volume by cell of left and right flanks over what one tooth bears when it goes through the mesh
/// once, for k = 1 m^2/N.
struct PassedVolume {
  Eigen::MatrixXd of[2];
};

/// From the contacts of all pairs of a result over whole pitches. gears: by member of the drive.
std::vector<PassedVolume> passed_volume(const std::string& result, const Drive& drive,
                                        const std::vector<WearingGear>& gears);

/// Largest depth, m.
double largest_depth(const WearingGear& gear);
/// Worn mass of all teeth, kg. depth: m, by cell of left and right flanks.
double worn_mass(const WearingGear& gear, const Eigen::MatrixXd (&depth)[2]);

}  // namespace elastogear::app
