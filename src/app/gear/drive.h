#pragma once
// A drive file: several gears, their assembly and load. Every verb reads it and takes from it what it needs,
// so that meshes, bodies and places belong together.

#include <cmath>

#include "elastogear/drive/drive.h"
#include "elastogear/drive/facts.h"

namespace elastogear::app {

using drive::MeshDensity;
using DriveMember = drive::Member;
using DrivePair = drive::Pair;

/// A drive with the numbers of its design.
struct Drive : drive::Drive {
  drive::DriveFacts facts = {};
  double locking_friction = INFINITY;  ///< from which on the second gear cannot drive the first
};

}  // namespace elastogear::app
