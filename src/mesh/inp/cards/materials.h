#pragma once
// *MATERIAL, *ELASTIC, *DENSITY, *ORIENTATION and *SOLID SECTION of an Abaqus input file.

#include <map>
#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/material.h"
#include "mesh/inp/lines/inp_lines.h"
#include "mesh/inp/lines/inp_notes.h"
#include "mesh/inp/lines/inp_sets.h"

namespace elastogear::mesh {

struct InpMaterials {
  struct Section {
    std::string cell_set, material, orientation;  // the latter two in capitals
    int line = 0;
  };
  std::map<std::string, model::Material> materials;  // by name in capitals, units of the file
  std::map<std::string, model::Orientation> orientations;
  std::vector<Section> sections;
  std::string current;  // the *MATERIAL that *ELASTIC and *DENSITY belong to
};

/// Reads the card when it is one of these; false (and nothing read) when not. What it leaves out goes to
/// `notes`.
bool read_material_card(InpLines& in, const Keyword& key, InpMaterials& materials, InpNotes& notes);

/// A region for each section whose set has cells, in SI units; lengths of the file times `unit_in_m`. Error
/// for unknown sets, materials and orientations.
std::vector<model::MaterialRegion> material_regions(const InpLines& in, const InpMaterials& materials,
                                                    const InpSets& cell_sets, const Mesh& mesh,
                                                    double unit_in_m);

}  // namespace elastogear::mesh
