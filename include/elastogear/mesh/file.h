#pragma once
// Mesh files by their extension: Gmsh 4.1 (.msh) and Abaqus/CalculiX (.inp).

#include <cstdint>
#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/material.h"

namespace elastogear::mesh {

/// Further contents of a mesh file, and a list of what the reader left out.
struct ReadReport {
  std::vector<std::string> ignored;       ///< "*STATIC (line 12)": nothing is dropped without an entry
  std::vector<std::string> read_as;       ///< .inp: "C3D20R (line 3): ...", element types computed otherwise
  std::vector<std::int64_t> node_number;  ///< the file's numbers of the nodes, ascending like ours
  std::vector<model::MaterialRegion> regions;  ///< .inp: one for each *SOLID SECTION
  /// .inp: node sets of the mesh that *BOUNDARY holds, with directions ("BOUNDARY_z:z", see mesh/hold.h).
  std::vector<std::string> restrained;
};

/// Reads and validates. `unit_in_m`: length of one unit of the file's coordinates in m (0.001 for mm);
/// materials of the file are in N and s with it (MPa and t/mm^3 for mm). Error naming file and place for
/// anything that is not a complete mesh of known cells.
Mesh read_mesh(const std::string& path, double unit_in_m = 1, ReadReport* report = nullptr);

/// Validates and writes (binary for .msh), coordinates in m; the file appears only when complete.
void write_mesh(const std::string& path, const Mesh& mesh);

}  // namespace elastogear::mesh
