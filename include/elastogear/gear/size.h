#pragma once

#include <string>

namespace elastogear::gear {

/// Mesh sizes on offer: about 5k nodes a body; 25-40k; 40k worm + 120k wheel; the paper's Tab. 1.
enum class Size { tiny, small, medium, paper };

/// A count of cells times a number, whole and at least 1.
int refined(int count, double times);
/// Rows that grow by this factor each, where there are so many times as many; 0: equal rows.
double refined_growth(double growth, double times);

/// Throws Error listing the names for any other name.
Size size(const std::string& name);

}  // namespace elastogear::gear
