#pragma once
// Inputs that can be computed with but are hardly meant: said once, as warnings.

#include <cstdint>
#include <string>
#include <vector>

#include "elastogear/dynamics/simulate.h"
#include "elastogear/io/stress_file.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/model/material.h"

namespace elastogear::app {

/// Moduli and densities that no material of a gear has, in Pa and kg/m^3, with the unit that they look like.
/// from_mesh: the mesh file gives them, else options material_...
void warn_of_materials(const std::vector<model::MaterialRegion>& regions, bool from_mesh);

/// A density, kg/m^3, that no material of a gear has, and the unit that it looks like. option: that gives it,
/// "option -density".
void warn_of_density(const std::string& option, double density);

/// The same of a strength or an endured stress, Pa.
void warn_of_strength(const std::string& option, double stress);

/// Cells that lock in materials of nearly no compressibility, at once or when they have relaxed, and what to
/// take instead.
void warn_of_locking(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions,
                     model::Element element);

/// Cells with corners that are nearly flat or folded. cell_number: those of the file; empty: ours.
void warn_of_shapes(const mesh::Mesh& mesh, const std::vector<std::int64_t>& cell_number);

/// A mesh (m) as large as a house, or as small as a grain, was read in another unit. unit_in_m: that it was
/// read in.
void warn_of_size(const mesh::Mesh& mesh, double unit_in_m);

/// Stresses that would stretch the stiffest material of the body by more than 5 %: strains that are small is
/// what the equations are linear in. body_file: where the materials are.
void warn_of_strain(const io::StressSet& set, const std::string& body_file);

/// Pairs of bodies without a contact in the whole run.
void warn_of_idle_pairs(const dynamics::RunSummary& run);

}  // namespace elastogear::app
