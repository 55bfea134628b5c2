#pragma once
// A fingerprint tells whether two body files hold the same body for a run.

#include <string>

#include "elastogear/model/elastic_body.h"

namespace elastogear::model {

/// 16 hexadecimal digits, of all that dynamics reads of a body: bodies with the same ones have the same
/// elastic coordinates. Names, provenance and what only recovery needs do not count.
std::string fingerprint(const ElasticBody& body);

/// Key of the provenance of a result: fingerprint of what the file of this body held.
std::string identity_key(const std::string& body);
/// The same: "true" where the body is rigid in the run, whatever its file holds, and "false".
std::string rigid_key(const std::string& body);

}  // namespace elastogear::model
