#pragma once
// Estimated error of a figure from the same one on coarser meshes (docs/theory, section 10.7).

#include <vector>

namespace elastogear::evaluation {

/// How far the last value is from that of infinitely fine meshes, Eq. (10.15) to (10.17): the Grid
/// Convergence Index of ASME V&V 20. value: on at least two meshes, the coarsest first; refinement: their
/// numbers of cells along a line, up to a factor that they share. Throws Error unless these ascend.
double mesh_error(const std::vector<double>& value, const std::vector<double>& refinement);

}  // namespace elastogear::evaluation
