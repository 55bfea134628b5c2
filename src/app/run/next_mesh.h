#pragma once
// Which mesh a run takes next, by the error of the one before and by what a finer one costs.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace elastogear::app {

/// The number of rank 0, on all ranks. Collective; throws on all what it throws there.
double number_on_rank_0(const std::function<double()>& number);

/// Time (s) and memory (bytes) that a mesh takes on rank 0.
struct Cost {
  double seconds = INFINITY, memory = INFINITY;
};

/// What the work takes. Collective.
Cost timed(const std::function<void()>& work);

/// What the runs on a mesh took at most since its bodies were made, by its file; infinite where that is not
/// known. A later run that finds all there takes next to nothing, which says nothing of the next mesh.
/// Collective.
Cost known_cost(const std::string& file);
/// The same after a run that took `now`. of_bodies: have its bodies been made, too? Collective.
Cost cost_of(const std::string& file, const Cost& now, bool of_bodies);

/// The mesh to take after `mesh`, which is not the last of these refinements (times the counts of size tiny,
/// ascending). Meshes that would miss the accuracy are passed over as far as one beyond them is affordable.
/// error, accuracy: shares; cost: of `mesh`. Collective.
int finer_mesh(const std::vector<double>& refinements, int mesh, double error, double accuracy,
               const Cost& cost);

/// Says what the mesh after `mesh` would take if time or memory do not suffice for it, or that there is none;
/// empty if they do. of_mesh: what `mesh` took. Collective.
std::string obstacle_to_finer(const std::vector<double>& refinements, int mesh, const Cost& of_mesh);

}  // namespace elastogear::app
