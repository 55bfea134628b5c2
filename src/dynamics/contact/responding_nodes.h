#pragma once
// Nodes at which the static responses beside the modes stand for the compliance of a body where it is
// touched.

#include <vector>

#include "elastogear/model/elastic_body.h"

namespace elastogear::dynamics {

/// Marks the surface nodes at which forces have a static response in the file of the body, of which its modes
/// leave more than a part of what the cells at the surface have. docs/theory.md, section 6.11.
std::vector<bool> responding_nodes(const model::ElasticBody& body);

}  // namespace elastogear::dynamics
