#pragma once
// Abaqus/CalculiX input files: mesh, sets, materials and restraint (docs/file_format.md).

#include <cstdint>
#include <functional>
#include <string>

#include "elastogear/base/file.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/mesh/read_report.h"

namespace elastogear::mesh {

/// Element types C3D4, 5, 6, 8, 10, 15, 20; letters behind (C3D8I, C3D20R) do not matter, because a body's
/// formulation is chosen when it is reduced. Set names match without regard to case and keep their first
/// spelling. Units as in read_mesh. Error naming file and line.
/// `instance`: which *INSTANCE of an *ASSEMBLY of several is read; empty: the only one.
Mesh read_inp(const std::string& path, double unit_in_m = 1, ReadReport* report = nullptr,
              const std::string& instance = "");

/// A file's content in memory; `open` gives that of the files it includes and throws Error when there is
/// none.
struct InpText {
  std::string path;  ///< for errors, and the folder that names of included files are relative to
  std::string content;
  std::function<std::string(const std::string& path)> open = read_file;
  std::string instance = {};  ///< which *INSTANCE is read; empty: the only one
  /// How many nodes and elements *NGEN and *ELGEN may make: a short line can ask for any number.
  std::int64_t most_generated = 20'000'000;
};
Mesh parse_inp(InpText text, double unit_in_m = 1, ReadReport* report = nullptr);

/// `element`: the type written for hex8; C3D8I has incompatible modes like our own default element.
void write_inp(const std::string& path, const Mesh& mesh, const std::string& element = "C3D8I");

}  // namespace elastogear::mesh
