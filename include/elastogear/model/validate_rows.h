#pragma once
// The part of model::validate that reads gigabytes, apart from the rest.

#include <string>

#include "elastogear/model/elastic_body.h"

namespace elastogear::model {

/// As validate(), of a body whose rows of Phi and Psi are known to be finite, as those that io has read are.
void validate_except_rows(const ElasticBody& body, const std::string& source);

}  // namespace elastogear::model
