#pragma once
// The names of element types, and what our own .inp files begin and end with.

#include <optional>
#include <string_view>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh::inp_format {

constexpr std::string_view kFirstLine =
    "** elastogear mesh, in m; complete with the last line '** end of mesh'\n";
constexpr std::string_view kLastLine = "** end of mesh\n";

/// Names of the element types, in the order of CellType; hex8 may be written as a variant.
constexpr std::string_view kElementTypes[kCellTypes] = {"C3D8", "C3D20", "C3D4", "C3D10",
                                                        "C3D6", "C3D15", "C3D5"};

/// "C3D8I", "C3D20R": the type's name and letters for its formulation. Capitals.
inline std::optional<CellType> cell_type(std::string_view element) {
  for (int i = 0; i < kCellTypes; ++i) {
    if (!element.starts_with(kElementTypes[i])) continue;
    const std::string_view variant = element.substr(kElementTypes[i].size());
    if (variant.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string_view::npos)
      return static_cast<CellType>(i);
  }
  return std::nullopt;
}

}  // namespace elastogear::mesh::inp_format
