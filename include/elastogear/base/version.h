#pragma once

namespace elastogear {

const char* version();   ///< "major.minor.patch"
const char* git_hash();  ///< commit the build was configured from, or "unknown"

}  // namespace elastogear
