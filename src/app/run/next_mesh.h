#pragma once
// Which mesh a run takes next, by the error of the one before and by what a finer one costs.

#include <functional>
#include <string>
#include <vector>

namespace elastogear::app {

/// The number of rank 0, on all ranks. Collective; throws on all what it throws there.
double number_on_rank_0(const std::function<double()>& number);

/// The mesh to take after `mesh`, which is not the last of these refinements (times the counts of size tiny,
/// ascending). Meshes that would miss the accuracy are passed over as far as one beyond them is affordable.
/// error, accuracy: shares; seconds: that `mesh` took, infinite where that is not known. Collective.
int finer_mesh(const std::vector<double>& refinements, int mesh, double error, double accuracy,
               double seconds);

/// Says what the mesh after `mesh` would take if time or memory do not suffice for it, or that there is none;
/// empty if they do. seconds: that `mesh` took. Collective.
std::string obstacle_to_finer(const std::vector<double>& refinements, int mesh, double seconds);

}  // namespace elastogear::app
