#pragma once
// Gmsh MSH 4.1 files. Sets are physical groups: 3-D groups are cell sets, 2-D groups face sets, 0-D groups of
// points node sets. Nodes and cells are numbered in the order of their tags (docs/file_format.md).

#include <string>

#include "elastogear/mesh/mesh.h"
#include "elastogear/mesh/read_report.h"

namespace elastogear::mesh {

enum class Encoding { ascii, binary };

/// Either encoding. Coordinates are multiplied by `unit_in_m`. Error naming file and line or byte offset.
Mesh read_msh(const std::string& path, double unit_in_m = 1, ReadReport* report = nullptr);
/// Reads a mesh from memory as read_msh does from a file; `path` names the content in errors.
Mesh parse_msh(const std::string& path, std::string content, double unit_in_m = 1,
               ReadReport* report = nullptr);

void write_msh(const std::string& path, const Mesh& mesh, Encoding encoding = Encoding::binary);

}  // namespace elastogear::mesh
