#pragma once
// Mesh files by their extension: Gmsh 4.1 (.msh) and Abaqus/CalculiX (.inp).

#include <string>

#include "elastogear/mesh/mesh.h"
#include "elastogear/mesh/read_report.h"

namespace elastogear::mesh {

/// Reads and validates. `unit_in_m`: length of one unit of the file's coordinates in m (0.001 for mm);
/// materials of the file are in N and s with it (MPa and t/mm^3 for mm). Error naming file and place for
/// anything that is not a complete mesh of known cells. `instance`: of an .inp with several, the one to read.
Mesh read_mesh(const std::string& path, double unit_in_m = 1, ReadReport* report = nullptr,
               const std::string& instance = "");

/// Validates and writes (binary for .msh), coordinates in m; the file appears only when complete.
void write_mesh(const std::string& path, const Mesh& mesh);

/// What a message on a file of unknown format says of the command that converts bulk data of Nastran into a
/// mesh; empty for files whose extension is not .bdf, .nas or .dat.
std::string way_from_bulk_data(const std::string& path);

/// Does a file begin as those of write_mesh() do? Error when it cannot be read.
bool is_written_mesh(const std::string& path);

}  // namespace elastogear::mesh
