#pragma once
// The choice of the next finer mesh of a run, by the estimated error so far and the cost of a finer mesh.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace elastogear::app {

/// The number of rank 0, on all ranks. Collective; throws on all what it throws there.
double number_on_rank_0(const std::function<double()>& number);

/// Time (s) and memory (bytes) that a mesh takes on rank 0; infinite where they are not known.
struct Cost {
  double seconds = INFINITY, memory = INFINITY;
};

/// What a file tells of earlier runs on a mesh: the most that any took since the bodies were made. A later
/// one that finds all there takes next to nothing, which says nothing of the next mesh. Collective.
Cost known_cost(const std::string& file);
/// Does the work on a mesh and returns what that took, or earlier work did; keeps it in the file. of_bodies:
/// are its bodies made, too? Collective.
Cost cost_of(const std::string& file, bool of_bodies, const std::function<void()>& work);

/// The mesh to take after `mesh`, which is not the last of these refinements (times the counts of size tiny,
/// ascending). Meshes that would miss the accuracy are passed over as far as one beyond them is affordable.
/// error, accuracy: shares; cost: of `mesh`. Collective.
int finer_mesh(const std::vector<double>& refinements, int mesh, double error, double accuracy,
               const Cost& cost);

/// Says what the mesh after `mesh` would take if time or memory do not suffice for it, or that there is none;
/// empty if they do. cost: of `mesh`. Collective.
std::string obstacle_to_finer(const std::vector<double>& refinements, int mesh, const Cost& cost);

}  // namespace elastogear::app
