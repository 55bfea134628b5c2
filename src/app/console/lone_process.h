#pragma once
// How MPI starts in a process that no launcher has started.

#include <string_view>

namespace elastogear::app {

/// Returns whether a variable of the environment, "NAME=value", is one by which a launcher (mpirun, srun)
/// tells a process its place.
bool is_of_launcher(std::string_view variable);

/// Before MPI is initialised. Open MPI looks for fast networks, which takes 0.3 s and is of no use to a
/// process that is alone: its plain point-to-point layer is taken, unless OMPI_MCA_pml says otherwise. Does
/// nothing under mpirun, srun or another launcher.
void start_alone_without_networks();

}  // namespace elastogear::app
