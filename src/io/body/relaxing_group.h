#pragma once
// Group /relaxing of a body file, and the Prony series of its materials.

#include <optional>
#include <string>
#include <vector>

#include "elastogear/model/elastic_body.h"
#include "elastogear/model/viscoelastic.h"
#include "io/hdf5/hdf5.h"

namespace elastogear::io {

/// Writes the relaxing parts of a body; without any, nothing.
void write_relaxing(const h5::File& file, const model::ElasticBody& body, const std::string& unit_of_K);
/// The parts; without their stress nodes where with_stress is false.
std::vector<model::RelaxingPart> read_relaxing(const h5::File& file, bool with_stress);

/// group: of the material, which exists.
void write_viscoelastic(const h5::File& file, const std::string& group, const model::Viscoelastic& material);
/// Nothing where the material is elastic.
std::optional<model::Viscoelastic> read_viscoelastic(const h5::File& file, const std::string& group);

/// "both", "shear", "bulk"; "none", "wlf", "arrhenius".
std::string modulus_part_name(model::ModulusPart part);
std::string shift_name(model::TemperatureShift::Law law);

}  // namespace elastogear::io
