#pragma once
// Abaqus/CalculiX input files, the mesh part: *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE (docs/file_format.md).

#include <string>

#include "elastogear/mesh/file.h"

namespace elastogear::mesh {

/// Element types C3D4, 5, 6, 8, 10, 15, 20; letters behind (C3D8I, C3D20R) do not matter, because a body's
/// formulation is chosen when it is reduced. Set names match without regard to case and keep their first
/// spelling. Coordinates are multiplied by `unit_in_m`. Error naming file and line.
Mesh read_inp(const std::string& path, double unit_in_m = 1, ReadReport* report = nullptr);
/// The same from memory; `path` names the content in errors.
Mesh parse_inp(const std::string& path, std::string content, double unit_in_m = 1,
               ReadReport* report = nullptr);

/// `element`: the type written for hex8; C3D8I has incompatible modes like our own default element.
void write_inp(const std::string& path, const Mesh& mesh, const std::string& element = "C3D8I");

}  // namespace elastogear::mesh
