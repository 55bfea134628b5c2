#pragma once
// A mesh file holds more than the mesh: materials, held nodes, and cards that are left out.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "elastogear/model/material.h"

namespace elastogear::mesh {

/// Further contents of a mesh file, and a list of what the reader left out.
struct ReadReport {
  std::vector<std::string> ignored;       ///< "*STATIC (line 12)": nothing is dropped without an entry
  std::vector<std::string> lost;          ///< "*SPRING (line 12): ...", what changes the body and is not read
  std::vector<std::string> read_as;       ///< .inp: "C3D20R (line 3): ...", element types computed otherwise
  std::vector<std::int64_t> node_number;  ///< the file's numbers of the nodes, ascending like ours
  std::vector<std::int64_t> cell_number;  ///< those of the cells
  std::vector<model::MaterialRegion> regions;  ///< .inp: one for each *SOLID SECTION
  /// .inp: node sets of the mesh that *BOUNDARY holds, with directions ("BOUNDARY_z:z", see mesh/hold.h).
  std::vector<std::string> restrained;
  std::map<std::string, double> point_mass;  ///< .inp: kg of all *MASS elements on each of these node sets
};

}  // namespace elastogear::mesh
