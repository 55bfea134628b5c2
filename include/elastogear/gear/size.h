#pragma once

#include <string>

namespace elastogear::gear {

/// Mesh sizes on offer: about 5k nodes a body; 25-40k; 40k worm + 120k wheel; the paper's Tab. 1.
enum class Size { tiny, small, medium, paper };

/// Throws Error listing the names for any other name.
Size size(const std::string& name);

}  // namespace elastogear::gear
