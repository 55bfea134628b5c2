#pragma once
// A drive file: several gears, their assembly and load. Every verb reads it and takes from it what it needs,
// so that meshes, bodies and places belong together.

#include <vector>

#include "app/gear/facts.h"
#include "elastogear/drive/drive.h"

namespace elastogear::app {

using drive::MeshDensity;
using DriveMember = drive::Member;
using DrivePair = drive::Pair;

/// A drive with the numbers of its design.
struct Drive : drive::Drive {
  std::vector<Facts> facts = {};       ///< of each member
  std::vector<Facts> pair_facts = {};  ///< of each pair
};

}  // namespace elastogear::app
