#pragma once
// Bodies without elastic coordinates.

#include "elastogear/model/elastic_body.h"

namespace elastogear::body {

/// m: kg; c: m, centre of mass in the BRF; J_c: kg m^2, about the centre of mass. No surface, no stress.
/// Throws Error unless the mass is positive, J_c symmetric and its principal values those of a mass
/// distribution.
model::ElasticBody rigid_body(double m, const Eigen::Vector3d& c, const Eigen::Matrix3d& J_c);

/// The body that does not deform: its inertia, surface and markers, no elastic coordinates and no stress.
model::ElasticBody rigid_copy(const model::ElasticBody& body);

}  // namespace elastogear::body
