#pragma once
// Materials of a body file without its mesh, which is most of what io::read_body_source reads.

#include <string>
#include <vector>

#include "elastogear/model/material.h"

namespace elastogear::io {

struct BodyMaterials {
  std::vector<model::MaterialRegion> regions;
  bool has_cells = false;  ///< whether the file has a mesh of them
};
BodyMaterials read_body_materials(const std::string& path);

}  // namespace elastogear::io
