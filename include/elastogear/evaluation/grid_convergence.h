#pragma once
// Estimated error of a figure from the same one on coarser meshes (docs/theory, section 10.7).

#include <vector>

namespace elastogear::evaluation {

/// How far the last value is from that of infinitely fine meshes, Eq. (10.15) to (10.17): the Grid
/// Convergence Index of ASME V&V 20. value: on at least two meshes, the coarsest first; refinement: their
/// numbers of cells along a line, up to a factor that they share. order: of the figure's convergence by
/// theory; 2 is that of strains in 20-node hexahedra. Throws Error unless refinements ascend.
double mesh_error(const std::vector<double>& value, const std::vector<double>& refinement, double order = 2);

/// The least refinement at which a figure with this error can be found to have a smaller one, of which an
/// order is shown: the error is one of two meshes, Eq. (10.15), and falls to that of Eq. (10.16). error,
/// error_wanted: > 0, in the same units; refinement: of the finer mesh.
double least_refinement(double error, double error_wanted, double refinement, double order = 2);

/// Raises each error to the median share, Eq. (10.18), of figures on the same meshes: the change of one
/// figure between two meshes may pass through zero, those of half of them do not. figure, error: of equal
/// length and in the same units; figures of zero have no share and keep their error. Throws Error for other
/// lengths.
void raise_to_median(const std::vector<double>& figure, std::vector<double>& error);

}  // namespace elastogear::evaluation
