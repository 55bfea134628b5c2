#pragma once
// Elasticity behind the flanks of a body.

#include <string>

#include "elastogear/model/elastic_body.h"

namespace elastogear::drive {

/// 1/Pa, (1 - nu^2) / E of the material of all cells at the surface of a body file; 0 where these have
/// several materials, orthotropic or viscoelastic ones, or the file holds no mesh.
double surface_compliance(const std::string& file, const model::Surface& surface);

}  // namespace elastogear::drive
