#include "elastogear/base/version.h"

namespace elastogear {

const char* version() { return ELASTOGEAR_VERSION; }
const char* git_hash() { return ELASTOGEAR_GIT_HASH; }

}  // namespace elastogear
